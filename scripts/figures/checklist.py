# SPDX-License-Identifier: Apache-2.0
"""Which figures have to be made, and by what. The list is written down apart from the pages on purpose: a page that loses a
figure is found out."""
import martin_popescu_2004
import ofek_rappoport_1998_results


class Paper:
    def __init__(self, key, page, title, source, figures):
        self.key, self.page, self.title, self.source, self.figures = key, page, title, source, figures


def number_figures(*modules):
    """Functions called figure_N, by N, in order."""
    found = {name[len("figure_"):]: function for module in modules for name, function in vars(module).items()
             if name.startswith("figure_")}
    return dict(sorted(found.items(), key=lambda item: (not item[0].isdigit(), int(item[0]) if item[0].isdigit() else 0)))


WANTED = {
    "1998": "9 12 15 16 17 18 19 20".split(),
    "2004": "1 8".split(),
}

PAPERS = (
    Paper("1998", "1998-ofek-rappoport.md", "1998: Interactive reflections on curved objects",
          "Eyal Ofek and Ari Rappoport, SIGGRAPH 98. Virtual objects, the reflection subdivision, explosion maps.",
          number_figures(ofek_rappoport_1998_results)),
    Paper("2004", "2004-martin-popescu.md", "2004: Reflection morphing",
          "Andrew Martin and Voicu Popescu, Purdue University, CSD TR 04-015.", number_figures(martin_popescu_2004)),
)
