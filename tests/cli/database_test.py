#!/usr/bin/env python3
"""The commands db, query, eval retrieval, signature and embed, as a user types them.

database_test.py TIMBRE"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import shapes

TIMBRE = sys.argv.pop(1)


class Commands(unittest.TestCase):
    def setUp(self):
        self.keep = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.keep.name)
        self.files = shapes.write_tori(self.folder, 6)
        self.db = str(self.folder / "shapes.timbre")

    def tearDown(self):
        self.keep.cleanup()

    def run_timbre(self, *args, code=0, stdin=None):
        done = subprocess.run([TIMBRE, *args], capture_output=True, text=True, input=stdin)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def json(self, *args, code=0):
        return json.loads(self.run_timbre(*args, "--json", code=code).stdout)

    def fill(self):
        labels = self.folder / "labels.txt"
        labels.write_text("".join(f"t{i:02}.off {'thick' if i < 3 else 'thin'} {i}\n" for i in range(6)))
        return self.run_timbre("db", "add", self.db, *self.files, "--labels", str(labels), "-k", "60")

    def test_add_acknowledges_in_order_keeps_and_lists(self):
        self.assertEqual(self.fill().stdout, "".join(f"added t{i:02}\n" for i in range(6)))
        self.assertEqual(self.run_timbre("db", "add", self.db, self.files[0]).stdout, "kept t00\n")
        listed = self.json("db", "list", self.db)["shapes"]
        self.assertEqual([s["name"] for s in listed], [f"t{i:02}" for i in range(6)])
        self.assertEqual(listed[0]["label"], "thick")
        self.assertEqual((listed[0]["vertices"], listed[0]["faces"]), (112, 224))
        self.assertEqual(self.json("db", "verify", self.db)["damaged"], [])

    def test_add_with_json_acknowledges_on_stderr(self):
        done = self.run_timbre("db", "add", self.db, *self.files[:2], "--json")
        self.assertEqual(done.stderr, "added t00\nadded t01\n")
        self.assertEqual(json.loads(done.stdout)["added"], 2)

    def test_add_goes_on_after_a_bad_file_and_ends_with_1(self):
        bad = self.folder / "bad.off"
        bad.write_text("OFF\n1 0\n")
        done = self.run_timbre("db", "add", self.db, self.files[0], str(bad), self.files[1], code=1)
        self.assertEqual(done.stdout, "added t00\nadded t01\n")
        self.assertTrue(done.stderr.startswith(f"timbre: {bad}: "), done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)

    def test_other_content_needs_replace(self):
        self.fill()
        done = self.run_timbre("db", "add", self.db, self.files[1], "--name", "t00", code=1)
        self.assertIn("is there with other content", done.stderr)
        done = self.run_timbre("db", "add", self.db, self.files[1], "--name", "t00", "--replace")
        self.assertEqual(done.stdout, "replaced t00\n")

    def test_other_parameters_are_refused(self):
        self.run_timbre("db", "create", self.db, "--mass", "consistent", "-k", "30")
        self.run_timbre("db", "create", self.db, code=2)
        self.run_timbre("db", "add", self.db, self.files[0])
        done = self.run_timbre("db", "add", self.db, self.files[1], "--mass", "lumped", code=2)
        self.assertIn("k=30 mass=consistent operator=robust", done.stderr)
        self.assertEqual(len(self.json("db", "list", self.db)["shapes"]), 1)

    def test_standard_input_needs_a_name(self):
        text = pathlib.Path(self.files[0]).read_text()
        self.run_timbre("db", "add", self.db, "-", code=1, stdin=text)
        done = self.run_timbre("db", "add", self.db, "-", "--name", "piped", stdin=text)
        self.assertEqual(done.stdout, "added piped\n")

    def test_remove(self):
        self.fill()
        self.assertEqual(self.run_timbre("db", "remove", self.db, "t01").stdout, "removed t01\n")
        self.run_timbre("db", "remove", self.db, "t01", code=2)
        self.assertEqual(len(self.json("db", "list", self.db)["shapes"]), 5)

    def test_export_gives_the_mesh_back(self):
        self.fill()
        out = str(self.folder / "out.off")
        self.run_timbre("db", "export", self.db, "t02", "-o", out)
        self.run_timbre("db", "export", self.db, "t02", "-o", out, code=2)
        self.run_timbre("db", "export", self.db, "t02", "-o", out, "--force")
        self.assertEqual(self.run_timbre("db", "add", self.db, out, "--name", "t02").stdout, "kept t02\n")
        values = self.run_timbre("db", "export", self.db, "t02", "--spectrum").stdout.split()
        self.assertEqual((len(values), values[0]), (60, "0"))

    def test_verify_names_damage_and_ends_with_1(self):
        self.fill()
        content = bytearray(pathlib.Path(self.db).read_bytes())
        for i in range(len(content) // 2, len(content)):
            content[i] ^= 0x55
        pathlib.Path(self.db).write_bytes(content)
        done = self.run_timbre("db", "verify", self.db, "--json", code=1)
        if done.stdout:
            self.assertTrue(json.loads(done.stdout)["damaged"])

    def test_query_ranks_the_stored_shapes(self):
        self.fill()
        answer = self.json("query", self.db, self.files[2], "-n", "3")
        self.assertEqual(len(answer["results"]), 3)
        first = answer["results"][0]
        self.assertEqual((first["rank"], first["name"], first["label"], first["score"]), (1, "t02", "thick", None))
        self.assertEqual(first["channels"], {"dna_weyl": first["distance"]})
        stored = self.json("query", self.db, "--stored", "t02", "-n", "0", "--channel", "dna_i")["results"]
        self.assertEqual(len(stored), 5)
        self.assertIn(stored[0]["name"], ("t01", "t03"))
        self.assertEqual(stored, sorted(stored, key=lambda r: r["distance"]))
        self.run_timbre("query", self.db, code=2)
        self.run_timbre("query", self.db, "--stored", "none", code=2)
        self.run_timbre("query", self.db, "--stored", "t02", "--channel", "none", code=2)

    def test_eval_agrees_with_a_count_over_queries(self):
        self.fill()
        for channel in ("dna_weyl", "gps_q"):
            report = self.json("eval", "retrieval", self.db, "--channel", channel)
            precisions, nearest = [], []
            for i in range(6):
                ranked = self.json("query", self.db, "--stored", f"t{i:02}", "-n", "0", "--channel", channel)["results"]
                relevant = [r["label"] == ("thick" if i < 3 else "thin") for r in ranked]
                hits = [rank for rank, is_hit in enumerate(relevant, 1) if is_hit]
                precisions.append(sum(n / rank for n, rank in enumerate(hits, 1)) / len(hits))
                nearest.append(relevant[0])
            self.assertAlmostEqual(report["map"], sum(precisions) / 6, 12)
            self.assertAlmostEqual(report["nn"], sum(nearest) / 6, 12)
            self.assertEqual([c["label"] for c in report["classes"]], ["thick", "thin"])

    def test_signatures_and_embeddings(self):
        for kind, rows, columns in (("dna", 50, 1), ("dna_log", 50, 1), ("gps", 64, 1),
                                    ("hks", 112, 64), ("wks", 112, 100)):
            answer = self.json("signature", self.files[0], "--kind", kind, "-k", "50")
            self.assertEqual((answer["rows"], answer["columns"], len(answer["values"])), (rows, columns, rows))
        for kind in ("gps", "diffusion", "biharmonic"):
            out = self.folder / f"{kind}.txt"
            self.run_timbre("embed", self.files[0], "--kind", kind, "-k", "5", "-o", str(out))
            lines = out.read_text().splitlines()
            self.assertEqual((len(lines), len(lines[0].split())), (112, 5))
            self.run_timbre("embed", self.files[0], "-o", str(out), code=2)
        for ending in ("npy", "npz"):
            out = self.folder / f"x.{ending}"
            self.run_timbre("signature", self.files[0], "-o", str(out))
            self.assertTrue(out.stat().st_size > 112 * 64 * 8)

    def test_foreign_files_get_one_line(self):
        for command in (("db", "list"), ("db", "verify"), ("db", "add")):
            extra = [self.files[1]] if command[1] == "add" else []
            done = self.run_timbre(*command, self.files[0], *extra, code=1)
            self.assertEqual(done.stderr, f"timbre: {self.files[0]}: not a timbre database\n")


if __name__ == "__main__":
    unittest.main()
