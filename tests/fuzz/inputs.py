#!/usr/bin/python3
r"""Stored inputs of a fuzz target: one file, an input a line, bytes beyond printable ASCII as
\n, \r, \t and \xNN, so that a change shows what it adds. Lines with # are comments.

  inputs.py unpack FILE.inputs FOLDER    each input as a file, as libFuzzer wants them
  inputs.py pack FILE.inputs FOLDER      replaces what stands below the last comment
  inputs.py keep FILE.inputs INPUT...    adds inputs that once failed above it
"""
import hashlib
import pathlib
import re
import sys

FOUND = "# Found by fuzzing, minimised: inputs.py pack."
LONGEST = 256  # bytes; longer ones of a minimised corpus are left out
ESCAPES = {10: "\\n", 13: "\\r", 9: "\\t", 92: "\\\\"}


def escaped(data):
    text = "".join(ESCAPES.get(b) or (chr(b) if 32 <= b < 127 else f"\\x{b:02x}") for b in data)
    return f"\\x23{text[1:]}" if text.startswith("#") else text


def unescaped(line):
    names = {value[1]: bytes([key]) for key, value in ESCAPES.items()}
    return b"".join(names[s[1]] if s[1:] in names else bytes.fromhex(s[2:]) if s[0] == "\\"
                    else s.encode("ascii") for s in re.findall(r"\\x[0-9a-f]{2}|\\.|[^\\]+", line))


def lines_of(path):
    return path.read_text("ascii").splitlines() if path.exists() else []


def unpack(path, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for line in lines_of(path):
        if line and not line.startswith("#"):
            data = unescaped(line)
            (folder / hashlib.sha1(data).hexdigest()).write_bytes(data)


def by_hand(path):
    lines = lines_of(path)
    return lines[:lines.index(FOUND)] if FOUND in lines else lines


def pack(path, folder):
    kept = by_hand(path)
    found = {escaped(file.read_bytes()) for file in folder.iterdir() if file.stat().st_size <= LONGEST}
    found = sorted(found - set(kept) - {""}, key=lambda line: (len(line), line))
    path.write_text("\n".join([*kept, FOUND, *found]) + "\n", "ascii")


def keep(path, files):
    lines = lines_of(path)
    place = len(by_hand(path))
    lines[place:place] = [escaped(file.read_bytes()) for file in files]
    path.write_text("\n".join(lines) + "\n", "ascii")


def main(command, path, *rest):
    rest = [pathlib.Path(name) for name in rest]
    actions = {"unpack": lambda: unpack(path, *rest), "pack": lambda: pack(path, *rest),
               "keep": lambda: keep(path, rest)}
    actions[command]()


if len(sys.argv) < 4 or sys.argv[1] not in ("unpack", "pack", "keep"):
    sys.exit(__doc__)
main(sys.argv[1], pathlib.Path(sys.argv[2]), *sys.argv[3:])
