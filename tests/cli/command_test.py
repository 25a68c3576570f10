"""What the tests of commands have in common: a folder of one's own, and how to run timbre."""
import pathlib
import subprocess
import tempfile
import unittest


class CommandTest(unittest.TestCase):
    TIMBRE = None  # set by the script that runs

    def setUp(self):
        self.keep = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.keep.name)

    def tearDown(self):
        self.keep.cleanup()

    def put(self, name, content):
        path = self.folder / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return str(path)

    def path(self, name):
        return str(self.folder / name)

    def run_timbre(self, *args, code=0, **options):
        done = subprocess.run([self.TIMBRE, *args], capture_output=True, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        return done
