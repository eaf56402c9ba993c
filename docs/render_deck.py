"""What the deck in a result says of its parts and units."""
import os

import h5py
import yaml

from beam_sections import profiled_parts

class Deck:
    """Names of the parts, in the order of the field `part`, and unit labels."""

    def __init__(self, result):
        with h5py.File(os.path.splitext(result)[0] + ".vtkhdf", "r") as file:
            text = file["deck/text"][()]
        deck = yaml.safe_load(text)
        self.parts = list(deck["parts"])
        self.profiled = profiled_parts(deck["parts"])  # by number
        self.units = deck.get("units") or {}

    def numbers(self, names):
        """Numbers of parts; a name may end in *, for all that begin so."""
        chosen = set()
        for name in names:
            found = [i for i, part in enumerate(self.parts)
                     if part == name or (name.endswith("*") and part.startswith(name[:-1]))]
            if not found:
                raise SystemExit(f"no part is called '{name}'; there are {', '.join(self.parts)}")
            chosen.update(found)
        return chosen

    def unit(self, field):
        """Label of the unit of a field; empty where the deck does not name it."""
        has = self.units
        if field.startswith(("stress", "von_mises", "von Mises", "pressure", "contact_pressure")):
            return has.get("stress") or (f"{has['force']}/{has['length']}\u00b2" if {"force", "length"} <= set(has) else "")
        if field.startswith(("displacement", "thickness", "radius", "contact_gap")):
            return has.get("length", "")
        if field.startswith("velocity"):
            return has.get("velocity") or (f"{has['length']}/{has['time']}" if {"length", "time"} <= set(has) else "")
        if field.startswith("contact_force"):
            return has.get("force", "")
        return has.get(field, "")


def ranges(numbers):
    """Numbers as the fewest ranges, first and last: [1, 2, 3, 7] -> [(1, 3), (7, 7)]."""
    found = []
    for number in sorted(numbers):
        if found and number == found[-1][1] + 1:
            found[-1] = (found[-1][0], number)
        else:
            found.append((number, number))
    return found
