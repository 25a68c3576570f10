#!/usr/bin/env python3
"""README and docs stay true: the C++ in the README is the file that the tests compile,
and every command it names exists and takes the options shown. No --help holds a byte that
is no text.

docs_test.py SOURCE_FOLDER TIMBRE"""
import pathlib
import re
import subprocess
import sys

source, timbre = pathlib.Path(sys.argv[1]), sys.argv[2]
readme = (source / "README.md").read_text()
problems = []

example = re.search(r"```cpp\n(.*?)\n```", readme, re.S)[1]
if example != (source / "docs/examples/first_steps.cpp").read_text().rstrip("\n"):
    problems.append("README.md: the C++ example differs from docs/examples/first_steps.cpp")


def help_of(words):
    done = subprocess.run([timbre, *words, "--help"], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else None


texts = [readme] + [path.read_text() for path in (source / "docs").glob("*.md")]
commands = {line.strip() for text in texts for line in re.findall(r"(?:^ {4}|`|\$ )timbre ([^`\n#]+)", text, re.M)}
for line in sorted(commands):
    words = line.split()
    if not re.fullmatch(r"[a-z]+", words[0]):
        continue
    name = [words[0]]
    if words[0] in ("db", "eval", "dataset") and len(words) > 1 and re.fullmatch(r"[a-z]+", words[1]):
        name.append(words[1])
    if name == ["dataset", "make"] and len(words) > 2:
        name.append(words[2])
    text = help_of(name)
    if text is None:
        problems.append(f"'timbre {line}': no such command")
        continue
    for option in re.findall(r"(?<!\S)--?[a-z][a-z0-9-]*", line):
        if not re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", text):
            problems.append(f"'timbre {line}': {' '.join(name)} has no {option}")



def all_commands(words=()):
    """Every command and its subcommands, as lists of words."""
    yield list(words)
    listed = re.search(r"^Subcommands:\n(.*?)(?:\n\n|\Z)", help_of(words), re.S | re.M)
    for name in re.findall(r"^  (\w+)", listed[1] if listed else "", re.M):
        yield from all_commands((*words, name))


helps = {" ".join(words): help_of(words) for words in all_commands()}
for name, text in helps.items():
    if re.search(r"[\x00-\x09\x0b-\x1f]", text):
        problems.append(f"'timbre {name} --help' holds control characters")
if not {"eval match", "dataset make creatures", "db add"} <= helps.keys():
    problems.append("not all commands were found")

for target in re.findall(r"\]\(([^)#:]+)\)", readme):
    if not (source / target).exists():
        problems.append(f"README.md: {target} does not exist")

print("\n".join(problems))
print(f"{len(commands)} commands in README and docs looked at")
sys.exit(bool(problems) or len(commands) < 8)
