#!/usr/bin/env python3
"""Presses heaps of bodies of all kinds flat and lets the audit look for what crosses.

    press.py BRIO [--scenes N] [--first K] [--seed S] [--keep FOLDER] [--twice]

A scene has two to six bodies as collide.py makes them, on top of or beside each other, between two presses of which the
upper one moves at 30 to 1000 m/s: rigid walls, with four more around them, shells, bricks or rigid plates. What is a
failure, and what is printed, is as in collide.py.
"""

import random

import collide

CELL = 0.26  # m


def heap(rng):
    """Bodies, and the lower and the upper corner of the space around them."""
    count = rng.choice([2, 3, 4, 6])
    if rng.choice(["column", "slab"]) == "column":
        places = [(0, 0, i) for i in range(count)]
    else:
        places = [(i % 2, i // 2 % 2, i // 4) for i in range(count)]
    parts = {}
    for i, place in enumerate(places):
        made = collide.part(rng, [CELL * x + rng.uniform(-0.01, 0.01) for x in place])
        if made["element"] == "rigid":
            made["element"] = "hex8"
        parts[f"body{i}"] = made
    lower, upper = ([CELL * (pick(place[k] for place in places) + side) for k in range(3)]
                    for pick, side in ((min, -0.8), (max, 0.8)))
    return parts, lower, upper


def walls(lower, upper, speed, friction):
    conditions = []
    for axis in range(3):
        for point, side in ((lower, 1), (upper, -1)):
            wall = {"point": [point[k] if k == axis else 0 for k in range(3)],
                    "normal": [side if k == axis else 0 for k in range(3)], "friction": friction}
            if axis == 2 and side < 0:
                wall["velocity"] = [0, 0, -speed]
            conditions.append({"rigid_wall": wall})
    return conditions


def press(rng, kind, size, middle, side):
    """A part whose pressing face has that middle; side: where the heap is."""
    made = {"material": "steel", "placement": {"translate": [middle[0], middle[1], middle[2] - 0.01 * side]}}
    if kind == "shells":
        made["mesh"] = {"plate": {"size": size, "elements": [rng.choice([1, 4, 9])] * 2}}
        made["element"] = {"type": "shell4", "thickness": 0.005}
    else:
        made["mesh"] = {"box": {"size": [*size, 0.02], "elements": [rng.choice([1, 3, 8])] * 2 + [1]}}
        made["element"] = "rigid" if kind == "rigid" else "hex8"
    return made


def scene(seed, number):
    rng = random.Random(f"press {seed} {number}")
    parts, lower, upper = heap(rng)
    speed = 10 ** rng.uniform(1.5, 3)
    friction = rng.choice([0, 0.2, 0.5])
    kind = rng.choice(["walls", "shells", "bricks", "rigid"])
    if kind == "walls":
        conditions = walls(lower, upper, speed, friction)
    else:
        conditions = []
        size = [upper[k] - lower[k] + 0.1 for k in range(2)]
        for name, corner, side, velocity in (("lower", lower, 1, 0), ("upper", upper, -1, -speed)):
            middle = [(lower[0] + upper[0]) / 2, (lower[1] + upper[1]) / 2, corner[2]]
            parts[name] = press(rng, kind, size, middle, side)
            conditions.append({"part": name, "velocity": {"x": 0, "y": 0, "z": velocity}})
            if kind != "bricks":
                conditions.append({"part": name, "fix": ["rx", "ry", "rz"]})
    end = rng.uniform(0.4, 0.75) * (upper[2] - lower[2]) / speed
    return {"title": f"Press {number} of seed {seed}", "materials": collide.MATERIALS, "parts": parts,
            "boundary_conditions": conditions, "contact": {"surfaces": "all", "friction": friction, "audit": True},
            "time": {"end": end}, "output": {"fields": {"every": end / collide.DUMPS}}}


if __name__ == "__main__":
    collide.main(__doc__, scene)
