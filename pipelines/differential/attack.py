"""Writes files of every format and quirk, reads them with Grainpipe and with other programs, and compares points, faces, columns and names.

usage: attack.py --reader PROGRAM [--files N] [--seed S] [--keep FOLDER] [--page FILE] [--only PART-OF-A-KIND] [--with-those-there]
Prints each difference with its file; exit 1 if there is one, 3 if a peer is missing (--with-those-there: if numpy is; kinds that others write are passed over)."""
import argparse
import collections
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np

PEERS = ["numpy", "laspy", "lazrs", "pye57", "open3d", "trimesh", "meshio", "plyfile", "pymeshlab"]


# Some peers tell formats by the file's name.
ENDINGS = {"ply-mesh": "ply", "text": "xyz", "polygon": "ply", "ply-head": "ply", "ply-lists": "ply", "stl-text": "stl", "obj-text": "obj",
           "pcd-head": "pcd", "dialect": "csv"}


# Peers whose module has another name.
MODULES = {"open3d_mesh": "open3d"}


def family_of(kind):
    return "cut files" if kind.startswith("cut ") else kind.split("/")[0]


def missing():
    return [name for name in PEERS if importlib.util.find_spec(name) is None]


class Reader:
    """Grainpipe's readers, as a process that answers file by file."""

    def __init__(self, program):
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def read(self, mode, path):
        """Data, or the text of the error."""
        from data import Data
        self.process.stdin.write(f"{mode} {path}\n".encode())
        self.process.stdin.flush()
        out = self.process.stdout
        word, _, rest = out.readline().decode(errors="replace").rstrip("\n").partition(" ")
        if word != "ok":
            return rest or "the reader has ended"
        rows, columns, faces = map(int, rest.split())
        names = [out.readline().decode().rstrip("\n") for _ in range(columns)]
        table = np.frombuffer(out.read(8 * rows * columns), "<f8").reshape(columns, rows)
        corners = np.frombuffer(out.read(12 * faces), "<u4").reshape(faces, 3)
        return Data(table[:3].T.copy(), dict(zip(names[3:], table[3:])), corners)


def judged(case, ours):
    """What is wrong with our answer; None if nothing is."""
    from data import difference
    if isinstance(ours, str):
        if ours.startswith("differs:"):
            return ours
        if case.refuse is not None:
            return None if case.refuse in ours else f"refused without '{case.refuse}': {ours}"
        return None if case.may_refuse else f"refused: {ours}"
    if case.refuse is not None:
        return f"accepted {len(ours.points)} points, {len(ours.faces)} faces of a file that is to be refused"
    return difference(ours, case.truth, case)


def run(args):
    import formats_dialects
    import formats_e57
    import formats_more
    import formats_ply
    import formats_scanner
    import formats_text
    import peers
    from data import difference
    rng = np.random.default_rng(args.seed)
    os.makedirs(args.keep, exist_ok=True)
    kinds = {}
    for module in (formats_ply, formats_scanner, formats_e57, formats_text, formats_dialects):
        kinds |= module.kinds(rng, args.keep)
    kinds |= formats_more.kinds(rng, args.keep, dict(kinds))
    kinds = {name: make for name, make in kinds.items() if args.only in name}
    reader, totals, bad = Reader(args.reader), collections.Counter(), []
    absent, passed_over = missing(), set()
    by_format = collections.defaultdict(collections.Counter)
    peer_count, peer_bad = collections.Counter(), collections.defaultdict(set)
    for number in range(args.files):
        name, make = list(kinds.items())[number % len(kinds)]
        form = name.removeprefix("cut ").split("/")[0]
        ending = "obj" if name.startswith("polygon/obj") else ENDINGS.get(form, form)
        target = os.path.join(args.keep, f"{number}.{ending}")
        try:
            case = make(target)
        except ModuleNotFoundError as error:
            if error.name not in absent:
                raise
            passed_over.add(name)
            continue
        ours = reader.read(case.mode, case.path)
        wrong = judged(case, ours)
        family = family_of(name)
        group = by_format[family]
        group["files"] += 1
        group["kinds"] = sum(family_of(kind) == family for kind in kinds)
        group["refused"] += isinstance(ours, str) and wrong is None
        if wrong:
            group["differ"] += 1
            bad.append(name)
            if bad.count(name) == 1:
                print(f"{name}: {case.path}: {wrong}", flush=True)
        there = [peer for peer in case.peers if MODULES.get(peer, peer) not in absent]
        for peer in there if number < len(kinds) * args.peer_rounds else ():
            peer_count[peer] += 1
            try:
                theirs = getattr(peers, peer)(case.path)
                other = difference(theirs, case.truth, case, only_known=True)
            except Exception as error:
                other = f"{type(error).__name__}: {error}"
            group["compared"] += 1
            known = next((why for part, program, why in peers.PEER_FAULTS if part in name and program == peer), None)
            if other and known:
                peer_bad[peer, known].add(name)
            elif other:
                if (name, peer) not in totals:
                    print(f"{name}: {case.path}: {peer} differs from what was written: {other}", flush=True)
                totals[name, peer] += 1
                group["unlisted"] += 1
        if not wrong and not args.keep_all:
            os.unlink(case.path)
    if absent:
        print(f"passed over: {len(passed_over)} of {len(kinds)} kinds, which {', '.join(absent)} would write")
    return kinds, by_format, peer_count, peer_bad, bad, totals


def page(args, kinds, by_format, peer_count, peer_bad):
    files = sum(group["files"] for group in by_format.values())
    lines = [f"{files} files of {len(kinds)} kinds, seed {args.seed}:", "",
             "| format | kinds | files | refused as documented | compared with other programs | differ |", "|---|---:|---:|---:|---:|---:|"]
    for name, group in sorted(by_format.items()):
        lines.append(f"| {name} | {group['kinds']} | {group['files']} | {group['refused']} | {group['compared']} | {group['differ'] + group['unlisted']} |")
    lines += ["", "| other program | compared | differs from what was written, and why |", "|---|---:|---|"]
    for peer, count in sorted(peer_count.items()):
        faults = "; ".join(f"{why} ({len(kinds)} kind{'s' if len(kinds) > 1 else ''})" for (program, why), kinds in sorted(peer_bad.items()) if program == peer)
        lines.append(f"| {peer} | {count} | {faults or '–'} |")
    return "\n".join(lines) + "\n"


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--reader", required=True)
    options.add_argument("--files", type=int, default=6000)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--peer-rounds", type=int, default=3, help="rounds over all kinds that other programs read, too")
    options.add_argument("--only", default="")
    options.add_argument("--keep")
    options.add_argument("--keep-all", action="store_true")
    options.add_argument("--page")
    options.add_argument("--with-those-there", action="store_true")
    args = options.parse_args()
    if "numpy" in missing() or missing() and not args.with_those_there:
        print("missing: " + " ".join(missing()))
        sys.exit(3)
    own = args.keep is None
    args.keep = os.path.abspath(args.keep or tempfile.mkdtemp(prefix="differential-"))
    kinds, by_format, peer_count, peer_bad, bad, unlisted = run(args)
    files = sum(group["files"] for group in by_format.values())
    print(f"{files} files of {len(kinds)} kinds: {len(bad)} differ, {sum(unlisted.values())} unlisted differences of other programs")
    if args.page:
        with open(args.page, "w") as file:
            file.write(page(args, kinds, by_format, peer_count, peer_bad))
    if own and not bad:
        shutil.rmtree(args.keep)
    sys.exit(1 if bad or unlisted else 0)


main()
