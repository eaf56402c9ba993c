#!/usr/bin/env python3
"""Opens a report in Chromium, without a network: it draws, its slider moves the picture, a part hides.

Usage: report_in_browser.py BRIO CHROMIUM
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from browser import Browser

# Solids fall on shells with a beam; particles beside them.
DECK = """
title: Falling block <&>
units: {length: mm, time: ms, mass: g, force: N, stress: MPa}
materials:
  soft: {model: elastic_plastic, density: 1e-3, youngs_modulus: 100, poissons_ratio: 0.3, yield_stress: 1, hardening_modulus: 5}
parts:
  block:
    mesh: {box: {size: [4, 4, 4], elements: [3, 3, 3]}}
    placement: {translate: [0, 0, 5]}
    element: hex8
    material: soft
  floor:
    mesh: {plate: {size: [12, 12], elements: [12, 12]}}
    element: {type: shell4, thickness: 0.5}
    material: soft
  post:
    mesh: {line: {start: [0, -5, 1], end: [0, -5, 6], elements: 4}}
    element: {type: beam2, section: {rectangle: {width: 0.6, height: 1}}, orientation: [1, 0, 0]}
    material: soft
  dust:
    mesh: {particles: {box: {size: [2, 2, 2], spacing: 0.5}}}
    placement: {translate: [4, 4, 4]}
    element: particle
    material: soft
boundary_conditions:
  - {set: floor.boundary, fix: [x, y, z, rx, ry, rz]}
initial_conditions:
  - {part: block, velocity: [0, 0, -20]}
contact: {surfaces: all}
time: {end: 0.3}
output: {fields: {every: 0.03}, history: {every: 0.003}}
"""

WIDTH, HEIGHT = 760, 520


def differing(a, b):
    """Number of pixels that differ visibly."""
    return sum(max(abs(p - q) for p, q in zip(one, other)) > 12
               for row, other_row in zip(a, b) for one, other in zip(row, other_row))


def is_coloured(pixel):
    return max(pixel) - min(pixel) > 60


class Page:
    def __init__(self, browser, page):
        self.browser = browser
        browser.open(page.as_uri())

    def box(self, selector):
        """Its middle half across: no legend and no buttons."""
        x, y, width, height = self.browser.run(
            f"(e => {{ e.scrollIntoView({{block: 'nearest'}}); const box = e.getBoundingClientRect();"
            f" return [box.x + scrollX, box.y + scrollY, box.width, box.height]; }})(document.querySelector('{selector}'))")
        return x + width / 4, y, width / 2, height

    def scene(self):
        return self.browser.picture(self.box("#canvas"))

    def set(self, selector, value, event):
        self.browser.run(f"(e => {{ e.value = '{value}'; e.dispatchEvent(new Event('{event}')); }})"
                         f"(document.querySelector('{selector}'))")

    def click(self, selector):
        self.browser.run(f"document.querySelector('{selector}').click()")

    def text(self, selector):
        return self.browser.run(f"document.querySelector('{selector}').textContent")


def expect(holds, what):
    print("ok  " if holds else "FAIL", what)
    if not holds:
        sys.exit(1)


def test_scene(page):
    first = page.scene()
    size = len(first) * len(first[0])
    expect(page.text("#fault") == "", "the scene is drawn")
    page.click("#views button")
    first = page.scene()
    background = [[row[0]] * len(row) for row in first]
    expect(0.05 * size < differing(first, background) < 0.9 * size, "what is drawn stands out against the background")

    page.set("#time", 10, "input")
    later = page.scene()
    expect(differing(first, later) > 0.01 * size, "the slider moves the picture")
    expect("(11 of 11)" in page.text("#clock"), "and the clock")
    page.set("#time", 0, "input")
    expect(differing(first, page.scene()) == 0, "and moves it back")

    for part in ["block", "floor", "post", "dust"]:
        page.click(f"[data-part={part}]")
        hidden = page.scene()
        expect(differing(first, hidden) > 0.001 * size, f"part {part} hides")
        page.click(f"[data-part={part}]")
    expect(differing(first, page.scene()) == 0, "and all come back")


def test_colours(page):
    page.set("#time", 10, "input")
    page.set("#field", "velocity", "change")
    coloured = sum(is_coloured(pixel) for row in page.scene() for pixel in row)
    expect(coloured > 2000, "a field colours the scene")
    expect("velocity" in page.text("#legend") and "mm/ms" in page.text("#legend"), "its legend has name and unit")
    before = page.scene()
    page.set("#range-max", "4", "change")
    expect(differing(before, page.scene()) > 1000, "another range colours anew")
    page.set("#field", "", "change")
    expect("block" in page.text("#legend"), "parts are the legend of colours by part")
    page.set("#cut-axis", "0", "change")
    expect(differing(before, page.scene()) > 1000, "a cut opens the scene")


def test_play(page):
    page.set("#time", 0, "input")
    page.click("#play")
    for _ in range(100):
        page.browser.run("new Promise(done => setTimeout(done, 300))")
        if float(page.browser.run("document.querySelector('#time').value")) > 0:
            break
    expect(float(page.browser.run("document.querySelector('#time').value")) > 0, "it plays")
    page.click("#play")


def test_texts(page):
    expect(page.text("#title") == "Falling block <&>", "title")
    expect("youngs_modulus" in page.text("#deck pre"), "deck")
    for word in ["kinetic", "relative error"]:
        expect(word in page.text("#energy"), f"{word} in the energy balance")
    expect("steps" in page.text("#summary") and "hex8" in page.text("#summary"), "summary")
    for column, wanted in {"section.waist_mx": "N mm", "section.waist_x": "N", "reaction.foot_z": "N", "spring.strut.force": "N",
                           "spring.strut.elongation": "mm", "hub.centre_x": "mm", "block.velocity_z": "mm/ms"}.items():
        expect(page.browser.run(f"unitOfColumn('{column}')") == wanted, f"{column} in {wanted}")


def test_histories(page):
    energies = page.browser.picture(page.box("#chart"))
    page.click("[data-column=kinetic] input")
    expect(differing(energies, page.browser.picture(page.box("#chart"))) > 100, "a column leaves the plot")


def main():
    brio, chromium = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "block.yaml").write_text(DECK)
        for command in (["run", "block.yaml", "--quiet"], ["report", "block.results"]):
            subprocess.run([brio, *command], cwd=folder, check=True)
        with Browser(chromium, WIDTH, HEIGHT) as browser:
            page = Page(browser, Path(folder) / "block.html")
            for test in (test_scene, test_colours, test_play, test_texts, test_histories):
                test(page)
            thrown, asked = browser.faults()
            expect(not thrown, f"nothing is thrown {thrown}")
            expect(not asked, f"nothing is asked of a network {asked}")


if __name__ == "__main__":
    main()
