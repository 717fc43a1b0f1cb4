# SPDX-License-Identifier: Apache-2.0
"""Martin & Popescu 2004, figures 1 and 8, and its figures in numbers."""
from page import Section, milliseconds, px, share


def figure_1(shop):
    section = Section("Figure 1: environment mapping, ray tracing, reflection morphing", "Columns and a cube close to a mirroring sphere. The "
                      "environment map shows them as if they were far away; ray tracing and reflection morphing show how close they are.")
    comparison = shop.compare("2004-1", "columns", ("environment-plain", "environment", "morphing"))
    section.strip([comparison.picture("environment-plain"), comparison.picture("raytrace"), comparison.picture("morphing")])
    section.strip([comparison.error("environment-plain"), comparison.error("environment"), comparison.error("morphing")])
    section.numbers(*comparison.table())
    morphed = comparison.objects("morphing", "share_le_1px")
    section.claim("reflection morphing draws the near columns and the cube where ray tracing does:", morphed >= 0.95,
                  f"{share(morphed)} of the object pixels within 1 px, median {px(comparison.objects('morphing', 'median_px'))} px.")
    mapped = comparison.objects("environment-plain", "median_px")
    section.claim("environment mapping fails to show how close they are:", mapped > 4,
                  f"median {px(mapped)} px off, {share(comparison.objects('environment-plain', 'share_lost'))} by 24 px or more (which is as far "
                  "as we look, so \"hundreds of pixels\" is neither confirmed nor denied).")
    return section


def figure_8(shop):
    section = Section("Figure 8: a hybrid reflector", "A teapot whose body is morphed and whose spout, handle and lid are environment-mapped: \"good "
                      "results can be obtained\" so.")
    comparison = shop.compare("2004-8", "teapot", ("environment", "morphing", "virtual-exact"))
    section.strip(comparison.beside_truth("morphing"))
    section.strip([comparison.picture("environment"), comparison.error("environment", "its error map")])
    section.numbers(*comparison.table())
    hybrid, mapped = (comparison.objects(method, "share_le_1px") for method in ("morphing", "environment"))
    section.claim("the hybrid is better than environment maps alone:", hybrid > mapped,
                  f"{share(hybrid)} of the object pixels within 1 px against {share(mapped)}.")
    return section
