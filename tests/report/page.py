"""The page of `isostat report --html` in headless Chromium. Exit status 77: there is none, nothing was tested.

Usage: page.py PROGRAM DATA [PICTURES]: the program, the folder tests/data, where screenshots go (default: nowhere).
"""

import base64
import csv
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

import browser

PROGRAM, DATA = sys.argv[1], Path(sys.argv[2]).resolve()
PICTURES = Path(sys.argv[3]) if len(sys.argv) > 3 else None

SCENE = """[packing]
file = "{start}"
{load}
[[programme]]
do = "up"
equilibria = 4
[[programme]]
do = "down"
from = 2
equilibria = 2
[output]
pictures = false
"""


def isostat(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


def names(state):
    """Names of the contacts of a state's JSON, as in the records."""
    for i, j, *image in state["contacts"]:
        yield f"{i}-{j}" + "".join(f"({mx},{my})" for mx, my in image)


class Reported:
    """A run, its page in the browser, and what is asked of every page."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        scene = cls.scene(Path(cls.scratch.name))
        cls.out = scene.parent / "run"
        for command in (("run", scene, "-o", cls.out, "-q"), ("report", cls.out, "--html", "--no-charts", "-q")):
            done = isostat(*command)
            assert done.returncode == 0, done.stderr
        cls.page = cls.out / "figures" / "trajectory.html"
        cls.browser = browser.Browser()
        cls.browser.open(cls.page)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.scratch.cleanup()

    def tearDown(self):
        self.assertEqual(self.browser.errors, [])

    def stored(self):
        """The stored states of equilibria."""
        return [json.loads(path.read_text()) for path in sorted((self.out / "states").glob("eq_*.json"))]

    def test_asks_for_nothing_but_itself(self):
        self.assertEqual({a for a in self.browser.addresses if not a.startswith("about:")},
                         {"file://" + str(self.page)})


class Run(Reported):
    """Of disks: the page shows the records."""

    start, load, ratio, periodic = DATA / "vertex100.txt", "", "σ₂/σ₁", False

    @classmethod
    def scene(cls, folder):
        # A name that would change what the browser takes for a script, were it not written with care.
        scene = folder / "<!--<script><img src=x onerror=stop()>.toml"
        shutil.copy(cls.start, folder)
        scene.write_text(SCENE.format(start=Path(cls.start).name, load=cls.load))
        return scene

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        with open(cls.out / "equilibria.csv") as file:
            lines = [line.lstrip("# ") for line in file]
        cls.rows = list(csv.DictReader(lines))
        cls.events = [json.loads(line) for line in (cls.out / "events.jsonl").read_text().splitlines()]

    def setUp(self):
        self.browser.size(1280, 900)
        self.browser.press("Home")

    def tearDown(self):
        super().tearDown()
        self.assertTrue(self.browser.value("document.getElementById('trouble').hidden"))

    def at(self, name):
        return int(self.browser.value(f"document.body.dataset.{name}"))

    def words(self):
        return self.browser.value("document.getElementById('where').textContent")

    def test_has_every_equilibrium_and_every_arc_of_the_records(self):
        shown = "document.querySelectorAll('#equilibria tbody tr').length"
        self.assertEqual(self.browser.value(shown), len(self.rows))
        self.assertEqual(self.at("ready"), 1 + len(self.events))
        self.assertEqual(self.browser.value("document.querySelectorAll('#left_out li').length"), 0)
        summary = self.browser.value("document.getElementById('summary').textContent")
        self.assertIn(f"{len(self.rows)} equilibria, {len(self.events)} arcs;", summary)

    def test_has_no_address_of_another_place(self):
        self.assertNotRegex(self.page.read_text(), r"https?://")

    def test_names_from_files_are_text(self):
        self.assertTrue(self.browser.value("document.title").startswith("<!--<script><img"))
        self.assertIn("<img", self.browser.value("document.getElementById('name').textContent"))
        self.assertEqual(self.browser.value("document.images.length"), 0)

    def test_shows_the_load_ratio_of_the_records(self):
        for number, row in enumerate(self.rows):
            self.browser.value(f"show(film.frameOf.get({number}))")
            text = self.words()
            self.assertIn(f"Equilibrium {number}:", text)
            ratio = float(text.split(f"{self.ratio} = ")[1].split(",")[0])
            self.assertLessEqual(abs(ratio - float(row["ratio"])), 1e-8 * float(row["ratio"]))

    def test_says_what_opens_and_closes_at_an_arc(self):
        for k, event in enumerate(self.events):
            self.browser.value(f"show(recorded.event.indexOf({k}))")
            here = self.browser.value("document.querySelector('#arcs tr.here').textContent")
            for contact in (event["opened"], event["closed"]):
                self.assertIn(contact, here)

    def test_packing_is_that_of_the_stored_states(self):
        for state in self.stored():
            q = self.browser.value(f"[...film.positions[film.frameOf.get({state['equilibrium']})]]")
            mean = sum(disk[2] for disk in state["disks"]) / len(state["disks"])
            for i, (x, y, _) in enumerate(state["disks"]):
                self.assertLess(abs(q[2 * i] - x), mean / 500)
                self.assertLess(abs(q[2 * i + 1] - y), mean / 500)

    def test_contacts_forces_and_rattlers_are_those_of_the_stored_states(self):
        for state in self.stored():
            number = state["equilibrium"]
            shown = self.browser.value(f"pairs(contactsOf({number})).map(pairOf).map(contactName)")
            known = dict(zip(names(state), state["forces"]))
            self.assertEqual(set(shown), set(known))
            forces = self.browser.value(f"[...film.forces[recorded.force[film.frameOf.get({number})]]]")
            carrying = [abs(f) for f in known.values() if f != 0]
            mean = sum(carrying) / len(carrying)
            for name, force in zip(shown, forces):
                self.assertEqual(force == 0, known[name] == 0, name)
                self.assertLess(abs(force / 16 - known[name] / mean), 1 / 16 + 1e-9)
            rattlers = self.browser.value(f"rattlersOf({number}).reduce((a, b) => a + b, 0)")
            self.assertEqual(rattlers, int(self.rows[number]["rattlers"]))

    def test_every_line_of_a_contact_begins_at_a_disk_and_is_as_long_as_its_radii_at_every_arc(self):
        lines = """Array.from({length: film.count}, (_, f) => {
            const place = inCell(film.positions[f]), list = contactsAt(f), r = run.packing.radii;
            let most = 0, twice = 0;
            for (let l = 0; l < list.length; l += 2) {
                const [i, j] = [list[l], list[l + 1]], begins = j < 0 ? [i] : [i, diskOf(j)];
                const drawn = segments({x: (u) => u, y: (v) => v}, place, i, j);
                drawn.forEach(([a, b, c, d], k) => {
                    const disk = begins[k], length = r[i] + (j < 0 ? 0 : r[diskOf(j)]);
                    most = Math.max(most, Math.abs(Math.hypot(c - a, d - b) - length),
                        Math.hypot(a - place.q[2 * disk], b - place.q[2 * disk + 1]));
                });
                twice += drawn.length - 1;
            }
            return [most / r.reduce((a, b) => a + b, 0) * r.length, twice];
        })"""
        for most, twice in self.browser.value(lines):
            self.assertLess(most, 4 / 256)
            self.assertEqual(twice > 0, self.periodic)


class TiltedCell(Run, unittest.TestCase):
    start, load, ratio, periodic = DATA.parents[1] / "examples/cells/tilted-100.json", '[load]\nloaded = "tilt"', "τ/σ₂", True


class Channel(Run, unittest.TestCase):
    start, periodic = DATA / "cells/channel_16.json", True


class Page(Run, unittest.TestCase):
    def test_lines_of_contacts_end_at_centres_and_on_walls(self):
        ends = self.browser.value("""[1, -1, -2].map((j) =>
            segment({x: (u) => u, y: (v) => v}, [1, 2, 5, 6, 30, 40].concat(Array(200).fill(0)), 0, j))""")
        length = self.browser.value("[film.positions[0].at(-2), film.positions[0].at(-1)]")
        self.assertEqual(ends, [[1, 2, 5, 6], [1, 2, 0, 2], [1, 2, 1, 0]])
        right, top = self.browser.value("""[-3, -4].map((j) =>
            segment({x: (u) => u, y: (v) => v}, film.positions[0], 0, j))""")
        self.assertEqual(right[2], length[0])
        self.assertEqual(right[3], right[1])
        self.assertEqual(top[3], length[1])
        self.assertEqual(top[2], top[0])

    def test_keys_go_through_the_run(self):
        self.assertEqual(self.at("frame"), 0)
        self.browser.press("ArrowRight")
        self.assertEqual(self.at("frame"), 1)
        self.browser.press("ArrowLeft")
        self.assertEqual(self.at("frame"), 0)
        self.browser.press("PageDown")
        self.assertIn("Equilibrium 1:", self.words())
        self.browser.press("PageUp")
        self.assertIn("Equilibrium 0:", self.words())
        self.browser.press("End")
        self.assertEqual(self.at("frame"), len(self.events))
        self.browser.press("f")
        self.assertFalse(self.browser.value("document.getElementById('forces').checked"))
        self.browser.press("f")
        self.assertTrue(self.browser.value("document.getElementById('forces').checked"))

    def test_space_plays_to_the_end_and_stops(self):
        self.browser.value("document.getElementById('speed').value = 120")
        self.browser.press(" ")
        self.browser.wait(f"document.body.dataset.frame == {len(self.events)}")
        self.browser.wait("document.getElementById('play').textContent === 'play'")

    def test_a_click_goes_to_the_nearest_equilibrium(self):
        x, y = self.browser.value("""(() => { const box = byId('stairs').getBoundingClientRect();
            return [box.left + chart.x(rows.eps2[3]) + 1, box.top + chart.y(rows.ratio[3]) + 1]; })()""")
        self.browser.click(x, y)
        self.assertIn("Equilibrium 3:", self.words())

    def test_forces_rattlers_and_changes_are_drawn(self):
        self.browser.press("PageDown")
        count = """(ids) => { for (const id of ['forces', 'rattlers', 'changes', 'motion'])
                byId(id).checked = ids.includes(id);
            drawPacking();
            const c = byId('packing'), data = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
            let n = 0;
            for (let k = 0; k < data.length; k += 4)
                n += Math.abs(data[k] - COLOUR[0]) + Math.abs(data[k+1] - COLOUR[1]) + Math.abs(data[k+2] - COLOUR[2]) < 24;
            return n; }"""
        for what, colour in (("forces", [140, 28, 19]), ("rattlers", [159, 184, 207]), ("changes", [217, 122, 0]),
                             ("motion", [17, 17, 17])):
            function = count.replace("COLOUR", json.dumps(colour))
            without = self.browser.value(f"({function})([])")
            drawn = self.browser.value(f"({function})(['{what}'])")
            self.assertGreater(drawn, without + 20, what)
        self.browser.value("for (const id of ['forces', 'rattlers', 'changes', 'motion']) byId(id).checked = true; draw()")

    def test_the_packing_is_saved_as_svg_and_curves_have_a_legend(self):
        self.browser.press("Home")
        drawing = xml.etree.ElementTree.fromstring(self.browser.value("picture()"))
        paths = [path.attrib for path in drawing.iter() if path.tag.endswith("path")]
        circles = sum(path["d"].count("A") / 2 for path in paths if path["fill"] != "none")
        disks, copies = self.browser.value("[run.packing.radii.length, run.packing.periodic.some((p) => p)]")
        self.assertTrue(circles == disks or (copies and circles > disks), (circles, disks))
        self.assertTrue(any(path.get("stroke") == "#8c1c13" for path in paths))  # forces
        self.assertEqual(self.browser.value("[short(-1e-17), sci(7e-17, 2), short(1e-9), sci(null, 2)]"), ["0", "0.00e+0", "1e-9", "–"])
        self.assertEqual(self.browser.value("document.querySelectorAll('#curves .key').length"), len(self.browser.value("run.segments")))

    def test_fits_windows_of_400_to_1600_pixels(self):
        self.browser.press("PageDown")
        for width in (400, 800, 1600):
            self.browser.size(width, 900)
            self.assertEqual(self.browser.value("innerWidth"), width)
            self.assertLessEqual(self.browser.value("document.documentElement.scrollWidth"), width)
            for canvas in ("stairs", "packing"):
                right = self.browser.value(f"byId('{canvas}').getBoundingClientRect().right")
                self.assertLessEqual(right, width)
                self.assertGreater(self.browser.value(f"byId('{canvas}').clientHeight"), 150)
            if PICTURES:
                (PICTURES / f"page-{width}.png").write_bytes(base64.b64decode(self.browser.picture()))


class Spheres(Reported, unittest.TestCase):
    """Of spheres in a cell, whose view turns."""

    @classmethod
    def scene(cls, folder):
        scene = folder / "s.toml"
        scene.write_text('[packing]\nspheres = 12\nseed = 3\n\n[cell]\nkind = "orthorhombic"\n[output]\npictures = false\n'
                         '[[programme]]\ndo = "up"\nequilibria = 2\nname = "<b>@DATA@"\n')
        return scene

    def drawn(self):
        """Spheres and lines drawn, the two angles of the view."""
        self.browser.settle()
        return [float(x) for x in self.browser.value("document.body.dataset.drawn").split()]

    def put(self, name, value):
        self.browser.value(f"const e = document.getElementById('{name}'); e.value = {value}; "
                           "e.dispatchEvent(new Event('input'))".replace("const e", "var e"))

    def tick(self, name):
        self.browser.value(f"document.getElementById('{name}').click()")

    def ink(self):
        """Pixels of the packing that are not blank."""
        return self.browser.value("pen.getImageData(0, 0, canvas.width, canvas.height).data"
                                  ".reduce((n, x, k) => n + (k % 4 == 3 && x > 0), 0)")

    def test_names_from_files_are_text(self):
        self.assertIn("<title>&lt;b&gt;@DATA@</title>", self.page.read_text())
        self.assertEqual(self.browser.value("document.querySelectorAll('b').length"), 0)

    def test_draws_the_spheres_contacts_and_forces_of_the_stored_states(self):
        for k, state in enumerate(sorted(self.stored(), key=lambda state: state["equilibrium"])):
            self.put("which", k)
            contacts = state["contacts"]
            self.assertEqual(self.drawn()[0], len(state["disks"]) + len(contacts))
            self.assertIn(f"Equilibrium {state['equilibrium']}: {len(state['disks'])} spheres",
                          self.browser.value("document.getElementById('what').textContent"))
            lines = self.browser.value(f"states[{k}].lines")
            forces = state["forces"]
            mean = sum(map(abs, forces)) / sum(f != 0 for f in forces)
            radius = [disk[-1] for disk in state["disks"]]
            for line, contact, force in zip(lines, contacts, forces):
                length = sum((a - b) ** 2 for a, b in zip(line[:3], line[3:6])) ** 0.5
                apart = radius[contact[0]] + radius[contact[1]]  # a line ends at the image that is touched
                self.assertLess(abs(length - apart), 1e-3 * apart)
                self.assertLess(abs(line[6] - force / mean), 1e-2 * max(1, abs(force) / mean))

    def test_turns_with_keys_and_the_pointer(self):
        self.browser.value("canvas.focus()")
        self.browser.press("0")
        before = self.drawn()
        self.browser.press("ArrowRight")
        self.assertAlmostEqual(self.drawn()[2 - 1], before[1] + 0.1, 3)
        place = self.browser.value("(r => [r.x + r.width / 2, r.y + r.height / 2])(canvas.getBoundingClientRect())")
        at = dict(button="left", buttons=1, clickCount=1)
        self.browser.ask("Input.dispatchMouseEvent", type="mousePressed", x=place[0], y=place[1], **at)
        self.browser.ask("Input.dispatchMouseEvent", type="mouseMoved", x=place[0] + 50, y=place[1] + 20, **at)
        self.browser.ask("Input.dispatchMouseEvent", type="mouseReleased", x=place[0] + 50, y=place[1] + 20, **at)
        self.assertNotAlmostEqual(self.drawn()[1], before[1] + 0.1, 2)
        self.assertNotAlmostEqual(self.drawn()[2], before[2], 2)

    def test_one_state_has_a_page_of_its_own(self):
        state = self.out / "states" / "last.json"
        done = isostat("report", state, "--html", "-q", "-o", self.out.parent / "one")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.browser.open(self.out.parent / "one" / "forces_last.html")
        known = json.loads(state.read_text())
        self.assertEqual(self.drawn()[0], len(known["disks"]) + len(known["contacts"]))
        self.browser.addresses.clear()
        self.browser.open(self.page)

    def test_leaves_out_what_is_not_asked_for(self):
        everything, ink = self.drawn()[0], self.ink()
        self.assertGreater(ink, 20000)
        self.put("cut", 0.5)
        part = self.drawn()[0]
        self.assertTrue(0 < part < everything)
        self.put("cut", 0)
        for name in ("spheres", "forces", "rattlers"):
            self.tick(name)
        self.assertEqual(self.drawn()[0], 0)
        self.assertLess(self.ink(), ink / 4)  # the edges of the cell stay
        for name in ("spheres", "forces", "rattlers"):
            self.tick(name)
        self.assertEqual(self.drawn()[0], everything)


if __name__ == "__main__":
    if browser.program() is None:
        print("chromium is not there: the page was not opened (Debian package chromium)")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
