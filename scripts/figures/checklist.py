# SPDX-License-Identifier: Apache-2.0
"""Which figures have to be made, and by what. The list is written down apart from the pages on purpose: a page that loses a
figure is found out."""
import bastos_stuerzlinger_1998
import blythe_1999
import martin_popescu_2004
import mcreynolds_blythe_2005
import ofek_rappoport_1998_results
import ofek_rappoport_1998_structures


class Paper:
    def __init__(self, key, page, title, source, figures):
        self.key, self.page, self.title, self.source, self.figures = key, page, title, source, figures


def number_figures(*modules):
    """Functions called figure_N, by N, in order."""
    found = {name[len("figure_"):]: function for module in modules for name, function in vars(module).items()
             if name.startswith("figure_")}
    return dict(sorted(found.items(), key=lambda item: int(item[0]) if item[0].isdigit() else 1000))


WANTED = {
    "1998": "4 5 9 10 11 12 13 14 15 16 17 18 19 20 scaling".split(),
    "1999": "61 62 63 64".split(),
    "2004": "1 3 5 6 7 8 numbers".split(),
    "2005": "17_3 17_4 masking".split(),
    "bastos": "2 3 4 5 6 7 rates".split(),
}

PAPERS = (
    Paper("1998", "1998-ofek-rappoport.md", "1998: Interactive reflections on curved objects",
          "Eyal Ofek and Ari Rappoport, SIGGRAPH 98. Virtual objects, the reflection subdivision, explosion maps.",
          number_figures(ofek_rappoport_1998_structures, ofek_rappoport_1998_results)),
    Paper("bastos", "1998-bastos-stuerzlinger.md", "1998: Forward mapped planar mirror reflections",
          "Rui Bastos and Wolfgang Stürzlinger, University of North Carolina. Depth-preserving reflection maps: zexels.",
          number_figures(bastos_stuerzlinger_1998)),
    Paper("1999", "1999-blythe.md", "1999: Convex reflectors, section 11.1.3.3",
          "David Blythe, SIGGRAPH 99 course notes on advanced graphics programming with OpenGL.", number_figures(blythe_1999)),
    Paper("2004", "2004-martin-popescu.md", "2004: Reflection morphing",
          "Andrew Martin and Voicu Popescu, Purdue University, CSD TR 04-015.", number_figures(martin_popescu_2004)),
    Paper("2005", "2005-mcreynolds-blythe.md", "2005: Reflections, section 17.1",
          "Tom McReynolds and David Blythe, Advanced Graphics Programming Using OpenGL.", number_figures(mcreynolds_blythe_2005)),
)
