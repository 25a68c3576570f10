#!/usr/bin/env python3
"""eval match, dataset info and dataset make, as a user types them.

eval_test.py TIMBRE"""
import fcntl
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

import shapes

TIMBRE = sys.argv.pop(1)
AS_ROOT = os.geteuid() == 0
JUDGE = pathlib.Path(__file__).resolve().parents[3] / "shared" / "data" / "judge_match.py"
PYTHON = "/usr/bin/python3"


def can_judge():
    if not JUDGE.exists() or not os.path.exists(PYTHON):
        return False
    return subprocess.run([PYTHON, "-c", "import numpy, scipy"], capture_output=True).returncode == 0


def read_numbers(path):
    return [int(word) for word in pathlib.Path(path).read_text().split()]


def write_map(path, images):
    pathlib.Path(path).write_text("".join(f"{v}\n" for v in images))
    return str(path)


def thin_truth(remeshed, cut):
    """Distances take time: a twelfth of the template, with its mirror images, is enough."""
    opposite = [int(row) for row in (remeshed / "symmetry.txt").read_text().split()[1:]]
    kept = {t for first in range(0, len(opposite), 12) for t in (first, opposite[first] - 1)}
    for path in (*remeshed.glob("*.vts"), *cut.glob("*.vts")):
        write_map(path, [v if t in kept else 0 for t, v in enumerate(read_numbers(path))])


def setUpModule():
    """Two poses of a dog, which all tests share and none changes."""
    Evaluation.keep_all = tempfile.TemporaryDirectory()
    creatures = pathlib.Path(Evaluation.keep_all.name) / "creatures"
    subprocess.run([TIMBRE, "dataset", "make", "creatures", "--sets", "remeshed,cut", "--species", "dog",
                    "--poses", "2", "--resolution", "4000", "-o", str(creatures)], check=True, capture_output=True)
    Evaluation.remeshed, Evaluation.cut = creatures / "remeshed", creatures / "cut"
    (line,) = (Evaluation.remeshed / "pairs.txt").read_text().splitlines()
    thin_truth(Evaluation.remeshed, Evaluation.cut)
    Evaluation.source, Evaluation.target = (name.removesuffix(".ply") for name in line.split())


def tearDownModule():
    Evaluation.keep_all.cleanup()


class Evaluation(unittest.TestCase):
    def setUp(self):
        self.keep = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.keep.name)

    def tearDown(self):
        self.keep.cleanup()

    def run_timbre(self, *args, code=0, **options):
        done = subprocess.run([TIMBRE, *map(str, args)], capture_output=True, text=True, timeout=300, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def refuse(self, line, *args, code):
        done = self.run_timbre(*args, code=code)
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr, f"timbre: {line}\n")

    def json(self, *args):
        return json.loads(self.run_timbre(*args, "--json").stdout)

    def mesh(self, name, folder=None):
        return str((folder or self.remeshed) / f"{name}.ply")

    def count_vertices(self, name):
        return read_count(self.mesh(name))

    def true_map(self, mirrored=False):
        """From .vts: the vertices that are asked for; others stay unanswered."""
        source = read_numbers(self.remeshed / f"{self.source}.vts")
        target = read_numbers(self.remeshed / f"{self.target}.vts")
        if mirrored:
            opposite = [int(row) for row in (self.remeshed / "symmetry.txt").read_text().split()[1:]]
            target = [target[t - 1] if t > 0 else 0 for t in opposite]
        images = [-1] * self.count_vertices(self.source)
        for p, q in zip(source, target):
            if p > 0 and q > 0:
                images[p - 1] = q - 1
        return images

    def maps(self, mirrored=False):
        folder = self.folder / "maps"
        folder.mkdir(exist_ok=True)
        write_map(folder / f"{self.source}_{self.target}.txt", self.true_map(mirrored))
        return folder


def read_count(path):
    with open(path, "rb") as file:
        for line in file:
            if line.startswith(b"element vertex"):
                return int(line.split()[2])
    raise ValueError(path)


class SingleMaps(Evaluation):
    def evaluate(self, images, *options, geodesic="graph"):
        path = write_map(self.folder / "map.txt", images)
        return self.json("eval", "match", self.mesh(self.source), self.mesh(self.target), path,
                         "--geodesic", geodesic, *options)

    def test_the_truth_is_right(self):
        answer = self.evaluate(self.true_map(), geodesic="exact")
        self.assertEqual(answer["geodesic"], "exact")
        self.assertLess(answer["mean_error"], 1.0)
        self.assertEqual((answer["found"], answer["matched"], answer["flipped"]), (1.0, 1.0, 0.0))
        (pair,) = answer["pairs"]
        self.assertEqual((pair["source"], pair["target"]), (f"{self.source}.ply", f"{self.target}.ply"))
        self.assertEqual(pair["pck"], sorted(pair["pck"]))
        self.assertEqual(len(pair["pck"]), len(answer["pck"]["error"]))
        self.assertEqual(pair["pck"][-1], 1.0)

    def test_the_mirror_image_of_the_truth_is_told_from_it(self):
        answer = self.evaluate(self.true_map(mirrored=True))
        self.assertGreater(answer["mean_error"], 5.0)
        self.assertEqual((answer["found"], answer["flipped"]), (0.0, 1.0))

    def test_what_is_not_answered_has_no_error(self):
        answer = self.evaluate([-1] * self.count_vertices(self.source))
        for field in ("mean_error", "mean_error_of_found", "flipped"):
            self.assertIsNone(answer[field], field)
        self.assertEqual((answer["found"], answer["matched"]), (0.0, 0.0))
        path = self.folder / "map.txt"
        text = self.run_timbre("eval", "match", self.mesh(self.source), self.mesh(self.target), path).stdout
        self.assertIn("error -, 0.0 % within 5, 0 % answered, not found", text)

    def test_a_truth_of_ones_own(self):
        right = write_map(self.folder / "truth.txt", self.true_map())
        answer = self.evaluate(self.true_map(), "--truth", right)
        self.assertEqual(answer["mean_error"], 0.0)

    def test_meshes_of_two_folders_need_a_truth(self):
        shutil.copy(self.mesh(self.source), self.folder / f"{self.target}.ply")
        source = self.folder / f"{self.target}.ply"  # named as the other
        path = write_map(self.folder / "map.txt", self.true_map())
        self.refuse("inputs: SOURCE and TARGET lie in different folders; --truth FILE has to tell the truth",
                    "eval", "match", source, self.mesh(self.target), path, code=2)
        answer = self.json("eval", "match", source, self.mesh(self.target), path, "--truth", path,
                           "--geodesic", "graph")
        self.assertEqual(answer["mean_error"], 0.0)

    def test_a_symmetry(self):
        points = read_numbers(self.remeshed / "dog0.vts")
        opposite = [int(row) for row in (self.remeshed / "symmetry.txt").read_text().split()[1:]]
        images = [-1] * self.count_vertices("dog0")
        for t, v in enumerate(points):
            if v > 0 and opposite[t] > 0 and points[opposite[t] - 1] > 0:
                images[v - 1] = points[opposite[t] - 1] - 1
        path = write_map(self.folder / "dog0.txt", images)
        answer = self.json("eval", "match", self.mesh("dog0"), path, "--kind", "sym")
        self.assertEqual((answer["mesh_rate"], answer["found"]), (1.0, 1.0))
        self.assertGreater(answer["correspondence_rate"], 0.99)
        self.assertIsNone(answer["flipped"])
        answer = self.json("eval", "match", self.remeshed, "--kind", "sym", "--maps", self.folder, "-n", "1")
        self.assertEqual((answer["mesh_rate"], len(answer["pairs"])), (1.0, 1))

    def test_maps_that_do_not_fit(self):
        source, target = self.mesh(self.source), self.mesh(self.target)
        n, m = self.count_vertices(self.source), self.count_vertices(self.target)
        path = write_map(self.folder / "map.txt", [0])
        self.refuse(f"{path}: has 1 lines; the source has {n} vertices", "eval", "match", source, target, path, code=1)
        write_map(path, [0] * (n - 1) + [m])
        self.refuse(f"{path}: line {n}: {m} is no vertex; there are {m}, from 0",
                    "eval", "match", source, target, path, code=1)
        pathlib.Path(path).write_bytes(b"\x00\x01\n")
        self.refuse(f"{path}: line 1: '\\x00\\x01' is no integer", "eval", "match", source, target, path, code=1)
        none = self.folder / "none"
        write_map(path, [0] * n)
        for inputs in ((self.remeshed / "none", target, path), (source, self.remeshed / "none", path),
                       (source, target, none)):
            done = self.run_timbre("eval", "match", *inputs, code=1)
            self.assertIn("none: open: No such file or directory\n", done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)

    def test_arrays_are_read_as_match_writes_them(self):
        images = self.true_map()
        header = f"{{'descr': '<i4', 'fortran_order': False, 'shape': ({len(images)},), }}"
        header = header.ljust(117) + "\n"
        data = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header.encode()
        path = self.folder / "map.npy"
        for last, code in ((images[-1], 0), (10**6, 1)):
            images[-1] = last
            path.write_bytes(data + b"".join(v.to_bytes(4, "little", signed=True) for v in images))
            self.run_timbre("eval", "match", self.mesh(self.source), self.mesh(self.target), path,
                            "--geodesic", "graph", code=code)

    def test_a_broken_list_beside_the_meshes_is_told(self):
        for name in os.listdir(self.remeshed):
            shutil.copy(self.remeshed / name, self.folder)
        path = write_map(self.folder / "map.txt", self.true_map())
        (self.folder / "labels.txt").write_text("cow0.ply cow\n")
        self.refuse(f"{self.folder}/labels.txt: line 1: 'cow0.ply' is not in the folder", "eval", "match",
                    self.folder / f"{self.source}.ply", self.folder / f"{self.target}.ply", path, code=1)

    def test_requests_that_make_no_sense(self):
        source, target = self.mesh(self.source), self.mesh(self.target)
        self.refuse("inputs: give SET, or SOURCE TARGET MAP", "eval", "match", source, target, code=2)
        self.refuse("inputs: give SET, or MESH MAP", "eval", "match", source, target, source, "--kind", "sym", code=2)
        self.refuse("truth: is of one map; a set has its own", "eval", "match", self.remeshed, "--truth", "t", code=2)
        self.refuse("inputs: --maps, --save-maps, -n and -o are for sets",
                    "eval", "match", source, target, source, "-n", "1", code=2)
        self.run_timbre("eval", "match", self.remeshed, "--kind", "none", code=2)
        self.run_timbre("eval", "match", self.remeshed, "-n", "-1", code=2)
        self.run_timbre("eval", "match", code=2)

    @unittest.skipUnless(can_judge(), "judge_match.py or numpy and scipy are not present")
    def test_the_graph_measures_as_the_judge_does(self):
        random.seed(1)
        wrong = self.true_map()
        for v in random.sample(range(len(wrong)), len(wrong) // 3):
            wrong[v] = random.choice(wrong)
        for images in (self.true_map(), wrong):
            answer = self.evaluate(images)
            done = subprocess.run([PYTHON, str(JUDGE), str(self.remeshed), f"{self.source}.ply", f"{self.target}.ply",
                                   str(self.folder / "map.txt"), "--json"], capture_output=True, text=True, check=True)
            judged = json.loads(done.stdout)
            self.assertAlmostEqual(answer["mean_error"], judged["mean"], delta=0.05)
            self.assertAlmostEqual(100 * answer["pairs"][0]["below5"], judged["below5"], delta=0.05)
            self.assertAlmostEqual(100 * answer["matched"], judged["matched"], delta=1e-9)
            self.assertEqual(answer["found"], judged["found"])
            self.assertEqual(answer["pairs"][0]["rows"], judged["points"])


class Sets(Evaluation):
    def test_given_maps(self):
        answer = self.json("eval", "match", self.remeshed, "--geodesic", "graph", "--maps", self.maps(), "-n", "100")
        self.assertLess(answer["mean_error"], 1.0)
        self.assertEqual((answer["found"], answer["matched"], len(answer["pairs"])), (1.0, 1.0, 1))
        mirrored = self.json("eval", "match", self.remeshed, "--geodesic", "graph", "--maps", self.maps(mirrored=True))
        self.assertEqual((mirrored["found"], mirrored["flipped"]), (0.0, 1.0))

    def test_a_part_is_found_by_nine_tenths(self):
        images = read_numbers(self.cut / "dog1.map")
        for share, found in ((0.95, 1.0), (0.85, 0.0)):
            kept = [v if i < share * len(images) else -1 for i, v in enumerate(images)]
            write_map(self.folder / "dog1_dog0.txt", kept)
            answer = self.json("eval", "match", self.cut, "--geodesic", "graph", "--maps", self.folder)
            self.assertEqual(answer["found"], found)
            self.assertAlmostEqual(answer["matched"], share, delta=0.03)

    def test_maps_are_computed_kept_and_judged_alike(self):
        kept = self.folder / "kept"
        made = self.json("eval", "match", self.remeshed, "--geodesic", "graph", "--save-maps", kept, "-k", "60")
        self.assertIn(made["pairs"][0]["verdict"], ("clear", "ambiguous", "failed"))
        self.assertEqual(len(read_numbers(kept / f"{self.source}_{self.target}.txt")), self.count_vertices(self.source))
        given = self.json("eval", "match", self.remeshed, "--geodesic", "graph", "--maps", kept)
        self.assertEqual(given["mean_error"], made["mean_error"])
        self.refuse(f"{kept}/{self.source}_{self.target}.txt: output: exists already; --force replaces it",
                    "eval", "match", self.remeshed, "--geodesic", "graph", "--save-maps", kept, "-k", "60", code=2)

    def test_maps_that_are_missing(self):
        none = self.folder / "none"
        self.refuse(f"{none}/{self.source}_{self.target}.txt: open: No such file or directory",
                    "eval", "match", self.remeshed, "--geodesic", "graph", "--maps", none, code=1)
        self.refuse(f"{none}: No such file or directory", "eval", "match", none, code=1)

    def test_a_set_without_pairs(self):
        (self.folder / "cat0.off").write_text(shapes.torus_off(2.0, 1.0))
        self.refuse(f"{self.folder}: holds no pair", "eval", "match", self.folder, code=1)
        self.refuse(f"{self.folder}: holds no shape of known symmetry",
                    "eval", "match", self.folder, "--kind", "sym", code=1)

    def test_names_of_any_bytes(self):
        first, second = b"a \xe9.off", b"b\n.off"
        for name in (first, second):
            with open(os.path.join(os.fsencode(self.folder), name), "w", encoding="ascii") as file:
                file.write(shapes.torus_off(2.0, 1.0))
        maps = self.folder / "maps"
        maps.mkdir()
        same = "".join(f"{v}\n" for v in range(112))
        with open(os.path.join(os.fsencode(maps), b"a \xe9_b\n.txt"), "w", encoding="ascii") as file:
            file.write(same)
        log = self.folder / "log"
        for kept in (0, 1):
            done = subprocess.run([TIMBRE, "eval", "match", self.folder, "--maps", maps, "-o", log, "--json"],
                                  capture_output=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(b"goes on after 1 results" in done.stderr, kept == 1)
            self.assertEqual(json.loads(done.stdout)["mean_error"], 0.0)


class Logs(Evaluation):
    def evaluate(self, log, *options, code=0, set_folder=None):
        return self.run_timbre("eval", "match", set_folder or self.folder / "set", "--maps", self.folder / "maps",
                               "-o", log, "--json", *options, code=code)

    def setUp(self):
        super().setUp()
        (self.folder / "set").mkdir()
        (self.folder / "maps").mkdir()
        for i in range(3):
            (self.folder / "set" / f"t{i}.off").write_text(shapes.torus_off(2.0, 1.0 - 0.1 * i))
        for a, b in ((0, 1), (0, 2), (1, 2)):
            write_map(self.folder / "maps" / f"t{a}_t{b}.txt", range(112))
        self.log = self.folder / "log.jsonl"

    def test_an_interrupted_run_goes_on(self):
        whole = json.loads(self.evaluate(self.log).stdout)
        content = self.log.read_bytes()
        self.assertEqual(content.count(b"\n"), 4)
        ends = [i + 1 for i, byte in enumerate(content) if byte == 10]
        for size in (0, 10, ends[0], ends[0] + 1, ends[1] + 20, ends[2], len(content) - 1, len(content)):
            self.log.write_bytes(content[:size])
            done = self.evaluate(self.log)
            self.assertEqual(json.loads(done.stdout), whole)
            self.assertEqual(self.log.read_bytes(), content)
            kept = max(0, content[:size].count(b"\n") - 1)
            self.assertEqual(f"goes on after {kept} results" in done.stderr, kept > 0)

    def test_what_is_in_the_log_is_not_judged_again(self):
        (pair,) = json.loads(self.evaluate(self.log, "-n", "1").stdout)["pairs"]
        stems = (pair["source"].removesuffix(".off"), pair["target"].removesuffix(".off"))
        (self.folder / "maps" / "{}_{}.txt".format(*stems)).unlink()
        self.assertEqual(json.loads(self.evaluate(self.log).stdout)["pairs"][0], pair)
        self.assertEqual(self.log.read_bytes().count(b"\n"), 4)

    def test_two_runs_do_not_share_a_log(self):
        with open(self.log, "w", encoding="ascii") as other:
            fcntl.flock(other, fcntl.LOCK_EX)
            done = self.evaluate(self.log, code=2)
        self.assertEqual(done.stderr, f"timbre: {self.log}: another run is writing to it\n")

    def test_other_options_need_force(self):
        self.evaluate(self.log)
        done = self.evaluate(self.log, "--geodesic", "graph", code=2)
        self.assertEqual(done.stderr,
                         f"timbre: {self.log}: was made with other options, or is no log; --force begins anew\n")
        content = self.log.read_bytes()
        self.evaluate(self.log, "--geodesic", "graph", "--force")
        self.assertNotEqual(self.log.read_bytes(), content)
        self.assertEqual(self.log.read_bytes().count(b"\n"), 4)

    def test_what_is_no_log_is_kept(self):
        self.evaluate(self.log)
        first = self.log.read_bytes().split(b"\n")[0] + b"\n"
        other = "was made with other options, or is no log; --force begins anew"
        broken = "holds a line that is no result; --force begins anew"
        for content, words in ((b"precious\n", other), (b"precious", "is no log; --force begins anew"),
                               (b"\x00\xff\n", other), (first + b"[]\n", broken), (first + b"{\"key\": 1}\n", broken),
                               (first + b"{\"key\":\"x\",\"result\":7}\n", broken)):
            self.log.write_bytes(content)
            done = self.evaluate(self.log, code=2)
            self.assertEqual(done.stderr, f"timbre: {self.log}: {words}\n")
            self.assertEqual(self.log.read_bytes(), content)

    def test_results_that_were_edited_are_refused(self):
        self.evaluate(self.log)
        lines = self.log.read_text().splitlines()
        entry = json.loads(lines[1])
        del entry["result"]["pck"]
        self.log.write_text("\n".join([lines[0], json.dumps(entry)]) + "\n")
        done = self.evaluate(self.log, "-q", code=2)
        self.assertEqual(done.stderr, f"timbre: {self.log}: holds a line that is no result; --force makes it again\n")
        self.evaluate(self.log, "--force")
        self.evaluate(self.log)

    def test_places_that_take_no_log(self):
        fifo = self.folder / "fifo"
        os.mkfifo(fifo)
        for place, code, words in ((self.folder, 1, f"{self.folder}: open: Is a directory"),
                                   (fifo, 2, f"{fifo}: is no regular file"),
                                   ("/dev/null", 2, "/dev/null: is no regular file"),
                                   (self.folder / "none" / "log", 1,
                                    f"{self.folder}/none/log: open: No such file or directory"),
                                   ("-", 2, "output: a log needs a file, not standard output")):
            done = self.evaluate(place, code=code)
            self.assertEqual(done.stderr, f"timbre: {words}\n")

    @unittest.skipIf(AS_ROOT, "to root every folder is writable")
    def test_a_folder_that_is_locked(self):
        locked = self.folder / "locked"
        locked.mkdir(mode=0o500)
        done = self.evaluate(locked / "log", code=1)
        self.assertEqual(done.stderr, f"timbre: {locked}/log: open: Permission denied\n")


class Datasets(Evaluation):
    def test_info_of_creatures(self):
        answer = self.json("dataset", "info", self.remeshed)
        self.assertEqual((answer["layout"], answer["classes"], answer["pairs_listed"]), ("listed", {"dog": 2}, True))
        self.assertEqual([(s["file"], s["truth"], s["symmetry"]) for s in answer["shapes"]],
                         [("dog0.ply", "vts", True), ("dog1.ply", "vts", True)])
        self.assertEqual(answer["pairs"], [[f"{self.source}.ply", f"{self.target}.ply"]])
        self.assertEqual(len(self.json("dataset", "info", self.cut)["pairs"]), 1)
        text = self.run_timbre("dataset", "info", self.remeshed).stdout
        self.assertIn("2 shapes, labels from a list in the folder\n  dog: 2\npairs: 1 listed in pairs.txt", text)

    def test_info_of_what_is_no_set(self):
        self.run_timbre("dataset", "info", self.folder, code=1)
        self.run_timbre("dataset", "info", self.folder / "none", code=1)
        self.run_timbre("dataset", "info", code=2)

    def test_analytic_shapes_know_their_eigenvalues(self):
        first = {"sphere": 2.0, "disk": 1.8411837813**2, "rectangle": math.pi**2 / 4, "cylinder": 1.0}
        for kind in ("sphere", "torus", "disk", "rectangle", "cylinder", "ellipsoid"):
            out = self.folder / f"{kind}.off"
            answer = self.json("dataset", "make", kind, "-o", out, "--resolution", "300")
            if kind not in first:
                self.assertIsNone(answer["eigenvalues"])
                continue
            self.assertEqual(len(answer["eigenvalues"]), 50)
            self.assertEqual(answer["eigenvalues"][0], 0.0)
            self.assertAlmostEqual(answer["eigenvalues"][1], first[kind], 8)
            computed = self.json("spectrum", out, "-k", "2")["eigenvalues"]
            self.assertAlmostEqual(computed[1] / first[kind], 1.0, delta=0.05)
        self.run_timbre("dataset", "make", "sphere", "-o", self.folder / "sphere.off", code=2)
        self.run_timbre("dataset", "make", "sphere", "-o", self.folder / "sphere.doc", code=2)


if __name__ == "__main__":
    unittest.main()
