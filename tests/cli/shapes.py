"""Small meshes for the tests of the command."""
import math


def torus_off(major, minor, nu=14, nv=8):
    """A torus of revolution as the text of an OFF file."""
    lines = ["OFF", f"{nu * nv} {2 * nu * nv} 0"]
    for i in range(nu):
        for j in range(nv):
            u, v = 2 * math.pi * i / nu, 2 * math.pi * j / nv
            r = major + minor * math.cos(v)
            lines.append(f"{r * math.cos(u)!r} {r * math.sin(u)!r} {minor * math.sin(v)!r}")
    for i in range(nu):
        for j in range(nv):
            a, b = i * nv + j, (i + 1) % nu * nv + j
            c, d = (i + 1) % nu * nv + (j + 1) % nv, i * nv + (j + 1) % nv
            lines += [f"3 {a} {b} {c}", f"3 {a} {c} {d}"]
    return "\n".join(lines) + "\n"


def square_off(n):
    """The unit square of n x n cells; vertex (n + 1) i + j is at (i / n, j / n)."""
    lines = ["OFF", f"{(n + 1) ** 2} {2 * n * n} 0"]
    lines += [f"{i / n!r} {j / n!r} 0" for i in range(n + 1) for j in range(n + 1)]
    for i in range(n):
        for j in range(n):
            a, b = (n + 1) * i + j, (n + 1) * (i + 1) + j
            lines += [f"3 {a} {b} {b + 1}", f"3 {a} {b + 1} {a + 1}"]
    return "\n".join(lines) + "\n"


def write_tori(folder, count):
    """Files t00.off, t01.off, ... that get thinner; their paths."""
    paths = []
    for i in range(count):
        paths.append(str(folder / f"t{i:02}.off"))
        with open(paths[-1], "w", encoding="ascii") as file:
            file.write(torus_off(2.0, 1.0 - 0.9 * i / count))
    return paths
