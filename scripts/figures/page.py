# SPDX-License-Identifier: Apache-2.0
"""A figure of a paper made again, as Markdown: what the paper shows, ours beside the truth, numbers, and which of its claims
the numbers bear out. A verdict is worked out from what was measured in this run, never written down beforehand."""


class Claim:
    """Something that a paper says, whether we see it, and the figures by which."""

    def __init__(self, text, holds, evidence):
        self.text, self.holds, self.evidence = text, holds, evidence

    def line(self):
        return f"- **{'seen' if self.holds else 'not seen'}**: {self.text} {self.evidence}"


def table(head, rows):
    lines = ["| " + " | ".join(map(str, row)) + " |" for row in [head, *rows]]
    lines.insert(1, "|" + " --- |" * len(head))
    return "\n".join(lines)


class Section:
    """One or several figures of a paper, in the order in which things are added."""

    def __init__(self, title, paper):
        self.title, self.parts, self.claims, self.files = title, [f"**In the paper.** {paper}"], [], []

    def text(self, text):
        self.parts.append(text)

    def strip(self, pictures):
        """[(caption, file relative to the page)]: side by side."""
        self.files += [file for _, file in pictures]
        self.parts.append(table([caption for caption, _ in pictures],
                                [[f"![{caption}]({file})" for caption, file in pictures]]))

    def numbers(self, head, rows):
        self.parts.append(table(head, rows))

    def claim(self, text, holds, evidence):
        self.claims.append(Claim(text, bool(holds), evidence))

    def markdown(self, commands):
        parts = [f"## {self.title}", *self.parts]
        if self.claims:
            parts.append("\n".join(claim.line() for claim in self.claims))
        if commands:
            parts.append("Made by\n\n" + "\n".join("    " + line for line in commands))
        return "\n\n".join(parts) + "\n"


def px(value):
    return "–" if value is None else f"{value:.2f}"


def share(value):
    return "–" if value is None else f"{100 * value:.1f} %"


def milliseconds(value):
    return "–" if value is None else f"{value:.0f} ms"
