#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""command_docs.py VERSION OUT_FOLDER: docs/command-line.md as a man page and as completions of bash, zsh and fish.

Files written: catoptric.1, catoptric.bash, _catoptric, catoptric.fish. What is read from the page: the table under "Commands"
(command names), and under "Options" each table with the line "For: COMMAND, ..." before it (option names, values,
meaning). A value is completed by what the meaning says: "one of `a`, `b`", or files, or folders.
"""
import os
import re
import sys

PAGE = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "docs", "command-line.md")


class Option:
    """One row of a table of options."""

    def __init__(self, cell, meaning, commands):
        names, _, self.value = cell.strip("`").partition(" ") if "," not in cell else cell.strip("`").rpartition(" ")
        if "," in cell and self.value.startswith("-"):  # "-q, --quiet" has no value
            names, self.value = cell.strip("`"), ""
        self.names = [name.strip() for name in names.split(",")]
        self.meaning = meaning.replace("`", "").split(";")[0]
        self.commands = commands
        words = re.findall(r"`([a-z][a-z-]+)`", re.split(r"; default|, and", meaning)[0])
        self.choices = words if re.search(r"\bof `", meaning) else []

    @property
    def long(self):
        return self.names[-1]


def table_rows(lines):
    rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines]
    return rows[2:]  # without the heading and its rule


def blocks(text):
    """(kind, lines) of the page: heading, table, code, paragraph."""
    for part in re.split(r"\n\s*\n", text.strip()):
        lines = part.splitlines()
        if lines[0].startswith("#"):
            yield "heading", lines
        elif lines[0].startswith("|"):
            yield "table", lines
        elif lines[0].startswith("    "):
            yield "code", [line[4:] for line in lines]
        else:
            yield "paragraph", lines


def read_page(text):
    commands, options, concerned = {}, [], []
    for kind, lines in blocks(text):
        if kind == "paragraph" and lines[0].startswith("For: "):
            concerned = lines[0][5:].split(", ")
        elif kind == "table" and "command" in lines[0]:
            commands = {cells[0].strip("`").split()[0]: cells[1].replace("`", "") for cells in table_rows(lines)}
        elif kind == "table" and "option" in lines[0]:
            options += [Option(cells[0], cells[1], concerned) for cells in table_rows(lines)]
    return commands, options


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"`([^`]*)`", r"\\fB\1\\fR", re.sub(r"^([.'])", r"\\&\1", text))


def make_man(text, version):
    out = [f'.\\" Made by scripts/command_docs.py from docs/command-line.md.\n.TH CATOPTRIC 1 "" "catoptric {version}"',
           ".SH NAME", "catoptric \\- true reflections in flat and curved mirrors, and their distance from the truth"]
    described = False
    for kind, lines in blocks(text):
        if kind == "heading":
            level, title = lines[0].split(" ", 1)
            if level != "#":
                out.append(f".SH {title.upper()}" if level == "##" else f".SS {title}")
        elif kind == "code":
            out += [".PP", ".nf", *[".RS 4\n" + roff(line) + "\n.RE" if line else "" for line in lines], ".fi"]
        elif kind == "table":
            for cells in table_rows(lines):
                out += [".TP", roff(cells[0] if cells[0].startswith("`") else f"`{cells[0]}`"), roff(cells[1])]
        elif lines[0].startswith("For: "):
            out += [".PP", roff("For " + lines[0][5:] + ".")]
        elif not lines[0].startswith("This page is the source"):
            out += [] if described else [".SH DESCRIPTION"]
            out += [".PP", *[roff(line) for line in lines]]
        described = described or kind == "paragraph"
    return "\n".join(out) + "\n"


def make_bash(commands, options):
    cases = []
    for name in commands:
        words = " ".join(option.long for option in options if name in option.commands)
        cases.append(f"    {name}) options='{words}' ;;")
    values = []
    for option in options:
        if option.choices:
            values.append(f"    {option.long}) COMPREPLY=($(compgen -W '{' '.join(option.choices)}' -- \"$current\")); return ;;")
        elif option.value in ("FILE", "DIR"):
            kind = "-f" if option.value == "FILE" else "-d"
            values.append(f"    {'|'.join(option.names)}) compopt -o filenames; "
                          f"COMPREPLY=($(compgen {kind} -- \"$current\")); return ;;")
        elif option.value:
            values.append(f"    {option.long}) return ;;")
    values = "\n".join(dict.fromkeys(values))
    return f"""# Made by scripts/command_docs.py from docs/command-line.md.
_catoptric() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} options=''
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W '{' '.join(commands)} --help --version' -- "$current"))
    return
  fi
  case $previous in
{values}
  esac
  case ${{COMP_WORDS[1]}} in
{chr(10).join(cases)}
  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  elif [ "${{COMP_WORDS[1]}}" = scenes ]; then
    COMPREPLY=($(compgen -W "$(catoptric scenes --quiet 2>/dev/null | awk '/^[a-z]/ {{ print $1 }}')" -- "$current"))
  else
    compopt -o filenames
    COMPREPLY=($(compgen -f -X '!*.@(gltf|glb)' -- "$current") $(compgen -d -- "$current"))
  fi
}}
complete -F _catoptric catoptric
"""


def make_zsh(commands, options):
    def quote(text):
        return text.replace("'", "'\\''").replace("[", "(").replace("]", ")").replace(":", "\\:")

    def spec(option):
        action = (f":value:({' '.join(option.choices)})" if option.choices else ":file:_files" if option.value == "FILE"
                  else ":folder:_files -/" if option.value == "DIR" else f":{option.value}: " if option.value else "")
        names = "{" + ",".join(option.names) + "}" if len(option.names) > 1 else option.long
        prefix = f"{names}'" if len(option.names) > 1 else f"'{names}"
        return f"{prefix}[{quote(option.meaning)}]{action}'"

    listed = "\n".join(f"    '{name}:{quote(summary)}'" for name, summary in commands.items())
    cases = []
    for name in commands:
        specs = " \\\n        ".join(spec(option) for option in options if name in option.commands)
        cases.append(f"    {name})\n      _arguments \\\n        {specs} \\\n        '*:scene:_files -g \"*.(gltf|glb)\"' ;;")
    return f"""#compdef catoptric
# Made by scripts/command_docs.py from docs/command-line.md.
_catoptric() {{
  local -a commands
  commands=(
{listed}
  )
  if (( CURRENT == 2 )); then
    _describe command commands
    _arguments '--help[print help]' '--version[print the version]'
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{chr(10).join(cases)}
  esac
}}
_catoptric "$@"
"""


def make_fish(commands, options):
    def quote(text):
        return text.replace("\\", "\\\\").replace("'", "\\'")

    lines = ["# Made by scripts/command_docs.py from docs/command-line.md.",
             "complete -c catoptric -n __fish_use_subcommand -l version -d 'print the version'",
             "complete -c catoptric -n __fish_use_subcommand -l help -d 'print help'"]
    for name, summary in commands.items():
        lines.append(f"complete -c catoptric -f -n __fish_use_subcommand -a {name} -d '{quote(summary)}'")
    for option in options:
        names = " ".join(f"-l {n[2:]}" if n.startswith("--") else f"-s {n[1:]}" for n in option.names)
        value = f" -x -a '{' '.join(option.choices)}'" if option.choices else " -r -F" if option.value in ("FILE", "DIR") \
            else " -x" if option.value else ""
        lines.append(f"complete -c catoptric -n '__fish_seen_subcommand_from {' '.join(option.commands)}' {names}{value} "
                     f"-d '{quote(option.meaning)}'")
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: command_docs.py VERSION OUT_FOLDER")
    version, folder = sys.argv[1:]
    with open(PAGE, encoding="utf-8") as file:
        text = file.read()
    commands, options = read_page(text)
    os.makedirs(folder, exist_ok=True)
    made = {"catoptric.1": make_man(text, version), "catoptric.bash": make_bash(commands, options),
            "_catoptric": make_zsh(commands, options), "catoptric.fish": make_fish(commands, options)}
    for name, content in made.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(content)


if __name__ == "__main__":
    main()
