#!/usr/bin/env python3
"""timbre report: the page as HTML, and in a browser where there is one.

report_test.py TIMBRE"""
import html.parser
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import browser
import shapes

TIMBRE = sys.argv.pop(1)
VOID = {"meta", "img", "link", "br"}
SECTIONS = ["gallery", "spectra", "functions", "maps", "symmetry", "figures", "making"]


def run_timbre(*args, code=0):
    done = subprocess.run([TIMBRE, *args], capture_output=True)
    assert done.returncode == code, (args, done.stderr)
    return done


class Page(html.parser.HTMLParser):
    """Reads a page and notes what is wrong with it."""

    def __init__(self, path):
        super().__init__()
        self.open, self.problems, self.ids, self.words, self.headings = [], [], [], [], []
        self.counts = {}
        self.text = path.read_bytes().decode()
        self.feed(self.text)
        self.close()
        self.problems += [f"<{tag}> stays open" for tag in self.open]
        self.problems += [f"id {one} twice" for one in set(self.ids) if self.ids.count(one) > 1]
        for level, before in zip(self.headings[1:], self.headings):
            if level > before + 1:
                self.problems.append(f"h{level} after h{before}")

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.counts[tag] = self.counts.get(tag, 0) + 1
        if tag not in VOID and not self.get_starttag_text().endswith("/>"):
            self.open.append(tag)
        if "id" in values:
            self.ids.append(values["id"])
        if re.fullmatch("h[1-6]", tag):
            self.headings.append(int(tag[1]))
        if tag == "img" and not values.get("alt"):
            self.problems.append("a picture without words")
        for name, value in attrs:
            if name in ("src", "href", "action", "data", "srcset") and not value.startswith("data:"):
                self.problems.append(f"{tag} {name}={value}")
            if name.startswith("on"):
                self.problems.append(f"{tag} {name}")

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.problems.append(f"</{tag}> closes nothing")

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("style", "script"):
            self.words.append(data)


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.keep = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.keep.name)

    @classmethod
    def tearDownClass(cls):
        cls.keep.cleanup()

    def path(self, name):
        return str(self.folder / name)

    def make(self, *args, name="report.html"):
        done = run_timbre("report", *args, "-o", self.path(name), "--force", "--json")
        answer = json.loads(done.stdout)
        self.assertEqual(answer["bytes"], os.path.getsize(self.path(name)))
        page = Page(self.folder / name)
        self.assertEqual(page.problems, [])
        self.assertEqual([one for one in page.ids if not one.endswith("-title")], answer["sections"])
        self.assertIn("default-src 'none'", page.text)
        return page, answer["sections"]


class WholePage(Report):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = cls.folder
        run_timbre("dataset", "make", "creatures", "-o", str(folder), "--sets", "remeshed", "-q", "--species",
                   "person,dog,octopus", "--poses", "3", "--resolution", "4000")
        cls.set = folder / "remeshed"
        cls.db = str(folder / "three.timbre")
        run_timbre("db", "add", cls.db, *sorted(map(str, cls.set.glob("*.ply"))), "--labels",
                   str(cls.set / "labels.txt"))
        for kind, number in (("map", "2"), ("sym", "1")):
            run_timbre("eval", "match", str(cls.set), "--kind", kind, "-n", number, "--geodesic", "graph",
                       "--samples", "500", "-q", "-o", str(folder / f"{kind}.jsonl"), "--save-maps", str(folder / kind))
        cls.logs = ["--matches", str(folder / "map.jsonl"), "--maps", str(folder / "map"), "--symmetries",
                    str(folder / "sym.jsonl"), "--symmetry-maps", str(folder / "sym")]

        cls.whole = folder / "whole.html"
        run_timbre("report", cls.db, "-o", str(cls.whole), "--set", str(cls.set), *cls.logs, "--title", "Three kinds")

    def test_everything(self):
        page = Page(self.whole)
        self.assertEqual(page.problems, [])
        sections = [one for one in page.ids if not one.endswith("-title")]
        self.assertEqual(sections, SECTIONS)
        self.assertLess(len(page.text), 4 << 20)
        text = " ".join(page.words)
        for words in ("Three kinds", "person0", "\u2713 same: dog", "timbre eval retrieval three.timbre", "mAP",
                      "mean error", "how far off the map is", "verdict", "correspondence rate"):
            self.assertIn(words, text)
        self.assertEqual(page.counts["canvas"], 1)
        self.assertEqual(page.counts["svg"], 2)
        # No path of this machine.
        self.assertNotIn(str(self.folder), page.text)

    def test_the_database_alone_is_enough(self):
        page, sections = self.make(self.db)
        self.assertEqual(sections, ["gallery", "spectra", "functions", "figures", "making"])
        self.assertNotIn("script", page.counts)
        self.assertNotIn("script-src", page.text)

    def test_meshes_of_the_database_serve_for_maps(self):
        page, sections = self.make(self.db, *self.logs)
        self.assertEqual(sections, SECTIONS)
        self.assertNotIn("how far off", page.text)

    def test_logs_without_maps(self):
        page, sections = self.make(self.db, *self.logs[:2], "--symmetries", self.path("sym.jsonl"))
        self.assertEqual(sections, ["gallery", "spectra", "functions", "maps", "figures", "making"])
        self.assertNotIn("canvas", page.counts)

    def test_what_does_not_fit_is_refused_in_one_line(self):
        bad = self.path("bad")
        os.makedirs(bad, exist_ok=True)
        pair = json.loads((self.folder / "map.jsonl").read_text().splitlines()[1])["result"]
        stems = [pair[end].rsplit(".", 1)[0] for end in ("source", "target")]
        (self.folder / "bad" / ("_".join(stems) + ".txt")).write_text("0\n1\n")
        (self.folder / "bad.jsonl").write_text("{}\n")
        for args, words, code in (
                (["--matches", self.path("map.jsonl"), "--maps", bad], "map: has 2 entries", 2),
                (["--matches", self.path("bad.jsonl")], "line 1: does not begin a log", 1),
                (["--matches", self.path("sym.jsonl")], "kind: is 'sym'; a log of kind 'map' is needed", 1),
                (["--matches", self.path("none.jsonl")], "none.jsonl: open: No such file", 1),
                (["--maps", bad], "--maps requires --matches", 2)):
            done = run_timbre("report", self.db, "-o", self.path("no.html"), *args, code=code)
            self.assertEqual((done.stdout, done.stderr.count(b"\n")), (b"", 1), done.stderr)
            self.assertIn(words.encode(), done.stderr)
            self.assertFalse(os.path.exists(self.path("no.html")))

    @unittest.skipUnless(browser.CHROMIUM, "no chromium; packages-dev.txt lists the Debian package")
    def test_in_a_browser(self):
        page = self.whole
        with browser.Browser() as chromium:
            for width, dark in ((360, False), (390, True), (1440, True)):
                chromium.show(page, width, 900, dark)
                needed = chromium.value("document.documentElement.scrollWidth")
                self.assertLessEqual(needed, width)
                self.assertTrue(chromium.wait_for("document.querySelector('.viewer').dataset.drawn === 'yes'"))
                self.assertTrue(chromium.value("[...document.images].every(one => one.naturalWidth > 0)"))
                self.assertEqual(chromium.value("document.querySelectorAll('section').length"), len(SECTIONS))
                dark_paper = chromium.value("getComputedStyle(document.body).backgroundColor === 'rgb(22, 24, 28)'")
                self.assertEqual(dark_paper, dark)
            self.turn_and_point(chromium)
            self.assertEqual(chromium.problems, [])
            self.assertEqual({url for url in chromium.requests if not url.startswith("data:")}, {page.as_uri()})

    def turn_and_point(self, chromium):
        canvas = "document.querySelector('canvas')"
        chromium.value(canvas + ".scrollIntoView({block: 'center'})")
        area = chromium.value(f"(({{x, y, width, height}}) => [x, y, width, height])({canvas}.getBoundingClientRect())")
        marked = "document.querySelector('.viewer').dataset.marked"
        for side in (0.25, 0.75):
            found = False
            for step in range(49):
                x, y = side - 0.09 + 0.03 * (step % 7), 0.3 + 0.06 * (step // 7)
                chromium.mouse("mouseMoved", area[0] + x * area[2], area[1] + y * area[3])
                found = found or chromium.value(marked) == "yes"
            self.assertTrue(found)
        chromium.mouse("mousePressed", area[0] + 0.25 * area[2], area[1] + 0.5 * area[3])
        chromium.mouse("mouseMoved", area[0] + 0.35 * area[2], area[1] + 0.5 * area[3])
        chromium.mouse("mouseReleased", area[0] + 0.35 * area[2], area[1] + 0.5 * area[3])
        chromium.value(canvas + ".focus()")
        for key in ("ArrowLeft", "ArrowUp", "+", "0"):
            chromium.key(key)
        for button in ("closer", "farther", "reset"):
            chromium.value(f"document.querySelector('[data-action={button}]').click()")

    @unittest.skipUnless(browser.CHROMIUM, "no chromium; packages-dev.txt lists the Debian package")
    def test_pictures_stand_where_there_is_no_3d(self):
        with browser.Browser("--disable-3d-apis") as chromium:
            chromium.show(self.whole, 1440, 900)
            self.assertEqual(chromium.value("document.querySelector('.viewer').dataset.state"), "still")
            self.assertGreater(chromium.value("document.querySelector('.still img').clientWidth"), 100)


class OddDatabases(Report):
    def test_one_shape_without_label(self):
        mesh = self.folder / "torus.off"
        mesh.write_text(shapes.torus_off(2.0, 0.7))
        run_timbre("db", "add", self.path("one.timbre"), str(mesh))
        page, sections = self.make(self.path("one.timbre"))
        self.assertEqual(sections, ["spectra", "functions", "making"])
        self.assertIn("The sound of one", page.words)
        again, _ = self.make(self.path("one.timbre"), "--threads", "1")
        self.assertEqual(again.text, page.text)

    def test_names_that_look_like_html(self):
        labels = self.folder / "labels.txt"
        for i, (name, radius) in enumerate((("<b>&\"'", 0.7), ("</script><svg>", 0.6), ("a&lt;b", 0.3))):
            mesh = self.folder / f"torus{i}.off"
            mesh.write_text(shapes.torus_off(2.0, radius))
            labels.write_text(f"torus{i}.off <i>{i // 2}\n")
            run_timbre("db", "add", self.path("odd.timbre"), str(mesh), "--name", name, "--labels", str(labels))
        page, _ = self.make(self.path("odd.timbre"), "--title", b"\xff<b>\xe2\x82\"")
        for word in ("<b>&\"'", "</script><svg>", "a&lt;b", "\ufffd<b>\ufffd\ufffd\""):
            self.assertIn(word, page.words)
        self.assertNotIn("i", page.counts)

    def test_an_empty_database_has_no_page(self):
        run_timbre("db", "create", self.path("none.timbre"))
        done = run_timbre("report", self.path("none.timbre"), "-o", self.path("none.html"), code=1)
        self.assertIn(b"none.timbre: holds no shapes", done.stderr)
        self.assertFalse(os.path.exists(self.path("none.html")))


if __name__ == "__main__":
    unittest.main()
