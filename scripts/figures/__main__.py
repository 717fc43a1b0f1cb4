# SPDX-License-Identifier: Apache-2.0
"""python3 scripts/figures COMMAND FOLDER [--size WxH] [--only PAPER-FIGURE,...]

Makes every figure of the papers again, with the built command, as Markdown pages in FOLDER: the paper's figure in words, ours,
the ray-traced truth, error maps, numbers then and now, and which of the paper's claims the numbers bear out. Ends with 1 if
a figure of checklist.py is missing. --only makes some of them (to work on a page; then FOLDER is not whole)."""
import argparse
import os
import shutil
import sys
import tempfile
import time

import checklist
from shop import Shop


def make_section(shop, paper, number, function):
    started = time.monotonic()
    print(f"{paper.key} figure {number} ...", end=" ", flush=True)
    section = function(shop)
    print(f"{time.monotonic() - started:.0f} s", flush=True)
    return section, shop.take_commands()


def write(path, text):
    with open(path + ".new", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".new", path)


def make_page(shop, paper, wanted):
    """Writes the page of one paper; returns its sections by figure."""
    made = {number: make_section(shop, paper, number, function) for number, function in paper.figures.items()
            if not wanted or f"{paper.key}-{number}" in wanted}
    if made:
        head = f"# {paper.title}\n\n{paper.source}\n\n[All figures](README.md)\n"
        parts = [section.markdown(commands) for section, commands in made.values()]
        write(os.path.join(shop.out, paper.page), "\n".join([head, *parts]))
    return {number: section for number, (section, _) in made.items()}


def make_index(shop, made, environment):
    lines = ["# The figures of the papers, made again", "", "Made by `make figures` from the command as it was built; nothing here is "
             "drawn or written by hand but the descriptions. A claim counts as seen when this run's figures say so.", "",
             ", ".join(f"{key}: {value}" for key, value in environment.items()) + ".", ""]
    for paper in checklist.PAPERS:
        sections = made.get(paper.key, {})
        claims = [claim for section in sections.values() for claim in section.claims]
        lines += [f"## [{paper.title}]({paper.page})", "", f"{len(sections)} figures; of {len(claims)} claims "
                  f"{sum(claim.holds for claim in claims)} are seen. Not seen:", ""]
        lines += [f"- {section.title}: {claim.text} {claim.evidence}" for section in sections.values()
                  for claim in section.claims if not claim.holds] or ["- nothing"]
        lines.append("")
    write(os.path.join(shop.out, "README.md"), "\n".join(lines))


def find_missing(shop, made):
    for paper in checklist.PAPERS:
        for number in checklist.WANTED[paper.key]:
            section = made.get(paper.key, {}).get(number)
            if section is None:
                yield f"{paper.key} figure {number} was not made"
                continue
            if not section.files:
                yield f"{paper.key} figure {number} shows nothing"
            for name in section.files:
                path = os.path.join(shop.out, name)
                if not os.path.isfile(path) or os.path.getsize(path) == 0:
                    yield f"{paper.key} figure {number}: {name} is not there"


def main():
    parser = argparse.ArgumentParser(prog="make figures")
    parser.add_argument("command")
    parser.add_argument("folder")
    parser.add_argument("--size", default="480x360")
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    wanted = set(filter(None, arguments.only.split(",")))
    known = {f"{paper.key}-{number}" for paper in checklist.PAPERS for number in paper.figures}
    if not wanted <= known:
        sys.exit(f"make figures: no figure {', '.join(sorted(wanted - known))}; there are {', '.join(sorted(known))}")
    if not wanted:
        shutil.rmtree(arguments.folder, ignore_errors=True)
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as work:
        shop = Shop(os.path.abspath(arguments.command), arguments.folder, work, arguments.size)
        shop.run("render", "checker-box", "-o", "a.png", "--size", "16x16", "--json", "a.json")
        environment = shop.read_json("a.json")["environment"]
        shop.take_commands()
        made = {paper.key: make_page(shop, paper, wanted) for paper in checklist.PAPERS}
        make_index(shop, made, environment)
    missing = [] if wanted else list(find_missing(shop, made))
    print(f"{sum(map(len, made.values()))} figures in {time.monotonic() - started:.0f} s: {arguments.folder}/README.md")
    sys.exit("\n".join(missing) if missing else 0)


if __name__ == "__main__":
    main()
