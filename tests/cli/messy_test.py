"""Real meshes with every oddity, where the public data set is present: `info` finds what is known
of them, `spectrum` is valid for each, and files without a surface get one line."""
import csv
import json
import pathlib
import sys
import unittest

import command_test

command_test.CommandTest.TIMBRE = sys.argv.pop(1)
MESSY = pathlib.Path(__file__).resolve().parents[3] / "shared" / "data" / "messy"

# Column of facts.tsv -> field of `info --json`, where both count the same.
OF_ANY = {"vertices": "vertices", "boundary_edges": "boundary_edges", "components": "components",
          "flipped_edges": "flipped_edges", "unused_vertices": "unused_vertices",
          "coincident_vertices": "coincident_vertices"}
# Of files with polygons these are of the polygons there, of their triangles here.
OF_TRIANGLES = {"faces": "faces", "nonmanifold_edges": "nonmanifold_edges",
                "nonmanifold_vertices": "nonmanifold_vertices",
                "duplicate_faces": "duplicate_faces"}
# One line of this file walks the same quad again and again: each round an edge more.
WALKS_IN_CIRCLES = "box_longline.obj"
# Triangles with a corner that comes again: `info` leaves them out, the facts keep their edges.
REPEATS_CORNERS = "spider_binary.stl"
# Read all the same: the face of two corners is left out with a word, another face is sound.
HAS_A_SOUND_FACE = "two_corner_face.obj"


@unittest.skipUnless(MESSY.is_dir(), "the public data set messy is not present")
class Messy(command_test.CommandTest):
    def files(self):
        with open(MESSY / "facts.tsv", encoding="ascii", newline="") as table:
            yield from csv.DictReader(table, delimiter="\t")

    def test_info_finds_what_is_known(self):
        for known in self.files():
            name = known["file"]
            done = self.run_timbre("info", "--json", str(MESSY / name))
            found = json.loads(done.stdout)
            fields = dict(OF_ANY)
            if set(known["polygons"].split(",")) == {f"3x{known['faces']}"}:
                fields |= OF_TRIANGLES
            for column, field in fields.items():
                if name == WALKS_IN_CIRCLES:
                    continue
                if name == REPEATS_CORNERS and field.startswith("nonmanifold"):
                    continue
                with self.subTest(file=name, fact=column):
                    self.assertEqual(found[field], int(known[column]))
            with self.subTest(file=name, fact="orientable"):
                self.assertEqual(found["orientable"], known["orientable"] == "yes")
            if "3x" + known["faces"] == known["polygons"]:
                with self.subTest(file=name, fact="worst angle"):
                    expected = float(known["worst_angle_deg"])
                    self.assertAlmostEqual(found["smallest_angle"], expected, delta=0.06 * expected)
                with self.subTest(file=name, fact="without area"):
                    self.assertGreaterEqual(found["degenerate_faces"],
                                            int(known["zero_area_faces"]))

    def test_spectrum_is_valid(self):
        for known in self.files():
            with self.subTest(file=known["file"]):
                done = self.run_timbre("spectrum", str(MESSY / known["file"]), "-k", "50", "--json")
                found = json.loads(done.stdout)
                values = found["eigenvalues"]
                self.assertEqual(values, sorted(values))
                self.assertEqual(values[0], 0.0)
                self.assertLessEqual(found["residual"], 1e-6)
                self.assertLessEqual(found["orthonormality"], 1e-8)
                self.assertGreaterEqual(found["certificate"]["count"], len(values))
                self.assertEqual(found["operator"], "robust")

    def test_what_is_no_surface_gets_one_line(self):
        for path in sorted((MESSY / "invalid").iterdir()):
            if path.suffix == ".md" or path.name == HAS_A_SOUND_FACE:
                continue
            with self.subTest(file=path.name):
                done = self.run_timbre("spectrum", str(path), "-k", "5", code=1)
                lines = done.stderr.decode().splitlines()
                self.assertEqual(len(lines), 1, lines)
                self.assertIn(f"timbre: {path}: ", lines[0])
                self.assertEqual(done.stdout, b"")


if __name__ == "__main__":
    unittest.main()
