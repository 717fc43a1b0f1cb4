# SPDX-License-Identifier: Apache-2.0
"""Ofek & Rappoport 1998, figures 9, 12 and 15 to 20: what their reflections look like, and how long they take."""
import charts
from page import Section, milliseconds, px, share

PUBLISHED, OURS = "virtual-explosion", "virtual-refined"
METHODS = ("environment-plain", "environment", PUBLISHED, OURS)


def show(section, comparison, ours=OURS):
    """Ours, truth, error; then the method as published and the environment map with theirs; then the numbers."""
    section.strip(comparison.beside_truth(ours))
    section.strip([comparison.picture(PUBLISHED), comparison.error(PUBLISHED, "its error map"),
                   comparison.picture("environment"), comparison.error("environment", "its error map")])
    section.numbers(*comparison.table())


def claim_better_than_environment(section, comparison):
    """The paper's conclusion, asked of the method as it was published, of both kinds of environment maps."""
    for method, name in (("environment-plain", "a plain environment map"), ("environment", "one corrected by the room's box")):
        published, other = (comparison.objects(m, "median_px") for m in (PUBLISHED, method))
        losses = [comparison.objects(m, "share_lost") for m in (PUBLISHED, method)]
        section.claim(f"explosion maps as published are nearer to the truth than {name}, and lose less:",
                      published < other and losses[0] <= losses[1],
                      f"median of object pixels {px(published)} px against {px(other)} px, within 1 px "
                      f"{share(comparison.objects(PUBLISHED, 'share_le_1px'))} against "
                      f"{share(comparison.objects(method, 'share_le_1px'))}, lost "
                      f"{share(losses[0])} against {share(losses[1])}.")


def claim_faster_than_rays(section, comparison, ours=OURS):
    frame, rays = comparison[ours]["median_ms"], comparison["raytrace"]["median_ms"]
    section.claim("an order of magnitude faster than ray tracing:", frame * 10 <= rays,
                  f"a frame takes {milliseconds(frame)}, the ray tracer {milliseconds(rays)}. Both run on the same two cores here, and the "
                  "rasterizer is software; Rayshade in 1998 was a ray tracer of 1998.")


def claim_right(section, comparison, text, method=OURS, least=0.99):
    within, lost = (comparison.objects(method, figure) for figure in ("share_le_1px", "share_lost"))
    section.claim(text, within >= least,
                  f"{share(within)} of the object pixels lie within 1 px of the truth (asked for: {share(least)}), {share(lost)} are lost.")


def figure_9(shop):
    section = Section("Figure 9: a mirror of mixed convexity", "A mirror whose one half is convex and whose other half is concave; the "
                      "picture in it goes over the border without a seam. They cut the mirror into parts by hand.")
    comparison = shop.compare("1998-9", "mixed", (*METHODS, "virtual-exact"))
    show(section, comparison, "virtual-exact")
    section.text("Ours is not cut: where a point has several reflections, each pixel's ray meets the real triangles (solver `exact`, which "
                 "`auto` picks here). The maps of the 1998 method know one reflection point for each direction, so the hollow half is beyond them.")
    claim_right(section, comparison, "no seam, with a solver that knows of several reflections:", "virtual-exact")
    claim_right(section, comparison, "no seam, by explosion maps over the whole mirror:", PUBLISHED)
    claim_better_than_environment(section, comparison)
    return section


def figure_12(shop):
    section = Section("Figure 12: a linear extrusion", "An upright cylinder, modelled as the extrusion of a circle, mirrors the floor and what "
                      "stands around it; its reflection points come from the plane subdivision of section 5, not from explosion maps.")
    comparison = shop.compare("1998-12", "cylinder", (*METHODS, "virtual-analytic"))
    show(section, comparison, "virtual-analytic")
    closed, maps = (comparison.objects(method, "median_px") for method in ("virtual-analytic", PUBLISHED))
    section.claim("the plane subdivision is more accurate than explosion maps:", closed < maps, f"median {px(closed)} px against {px(maps)} px.")
    times = [comparison[method]["reflection_ms"] for method in ("virtual-analytic", PUBLISHED)]
    section.claim("and more efficient:", times[0] < times[1],
                  f"reflections take {milliseconds(times[0])} against {milliseconds(times[1])}; the general search of `refined` "
                  f"{milliseconds(comparison[OURS]['reflection_ms'])}.")
    claim_better_than_environment(section, comparison)
    return section


def figure_15(shop):
    section = Section("Figure 15: four spheres, textured", "Four mirroring spheres on a table, real textures, shadows computed beforehand. "
                      "A second view of the scene of figure 16.")
    comparison = shop.compare("1998-15", "four-spheres", METHODS, "--eye", "0.62,1.42,1.25", "--target", "0.04,0.92,0.12",
                              "--fov", "36")
    show(section, comparison)
    claim_right(section, comparison, "reflections of four spheres at once:")
    claim_better_than_environment(section, comparison)
    return section


def figure_16(shop):
    section = Section("Figure 16: four spheres against a ray tracer", "The virtual objects method above, the ray tracer Rayshade below, 512 by 512 "
                      "pixels: the shapes are \"visually very similar\". Less than a second against 50 seconds on an SGI O2, the ray tracer "
                      "without shadow rays, highlights and anti-aliasing, one sample a pixel.")
    comparison = shop.compare("1998-16", "four-spheres", METHODS, size="512x512", repeat=3)
    show(section, comparison)
    section.numbers(["512 x 512", "then (SGI O2)", "now (two cores, software OpenGL)"],
                    [["virtual objects", "less than 1 s", milliseconds(comparison[OURS]["median_ms"])],
                     ["as published", "less than 1 s", milliseconds(comparison[PUBLISHED]["median_ms"])],
                     ["ray tracer", "50 s (Rayshade)", milliseconds(comparison["raytrace"]["median_ms"]) + " (Embree)"]])
    claim_right(section, comparison, "very similar shapes, with the search that starts from the maps:")
    claim_right(section, comparison, "very similar shapes, as published:", PUBLISHED, 0.5)
    claim_faster_than_rays(section, comparison)
    claim_better_than_environment(section, comparison)
    return section


def figure_17(shop):
    section = Section("Figure 17: a television", "The screen of a television, the extrusion of a convex plane curve, mirrors the room.")
    comparison = shop.compare("1998-17", "tv", (*METHODS, "virtual-analytic"))
    show(section, comparison, "virtual-analytic")
    claim_right(section, comparison, "a nearly flat mirror by the plane subdivision:", "virtual-analytic")
    claim_right(section, comparison, "explosion maps \"give good results even for planar or nearly planar reflectors\":", PUBLISHED, 0.5)
    claim_better_than_environment(section, comparison)
    return section


def figure_18(shop):
    section = Section("Figure 18: mirrors in mirrors", "A flat mirror seen in a flat mirror, several levels deep.")
    comparison = shop.compare("1998-18", "hall-of-mirrors", ("environment", OURS), "--bounces", "4")
    section.strip(comparison.beside_truth(OURS))
    section.strip([comparison.picture("environment"), comparison.error("environment", "its error map")])
    section.numbers(*comparison.table())
    claim_right(section, comparison, "recursive reflections in flat mirrors, four levels:")
    section.text("The paper has one level for curved mirrors and leaves more to future work; [reflection morphing](2004-martin-popescu.md) "
                 "and solver `exact` draw curved mirrors in curved mirrors.")
    return section


def figure_19(shop):
    section = Section("Figure 19: a mask of convex and concave pieces", "A face, some of whose pieces are convex and some concave, between a red "
                      "and a green ball, which both cheeks and the nose show. About a second on an SGI O2, a minute and a half by Rayshade.")
    comparison = shop.compare("1998-19", "mask", (*METHODS, "virtual-exact"))
    show(section, comparison, "virtual-exact")
    section.numbers(["", "then (SGI O2)", "now (two cores, software OpenGL)"],
                    [["virtual objects", "about 1 s", milliseconds(comparison["virtual-exact"]["median_ms"])],
                     ["ray tracer", "90 s (Rayshade)", milliseconds(comparison["raytrace"]["median_ms"]) + " (Embree)"]])
    claim_right(section, comparison, "the balls stand right on cheeks and nose, each pixel tested:", "virtual-exact")
    claim_right(section, comparison, "the same by one reflection point for each vertex:", OURS)
    claim_right(section, comparison, "the same by explosion maps as published:", PUBLISHED, 0.5)
    claim_faster_than_rays(section, comparison, "virtual-exact")
    return section


def figure_20(shop):
    section = Section("Figure 20: polyhedra and a sphere", "Several mirroring polyhedra and a mirroring sphere, in real time on an SGI Infinite "
                      "Reality; scenes like these at 1 to 30 frames a second on an O2.")
    comparison = shop.compare("1998-20", "polyhedra-and-sphere", METHODS, repeat=3)
    show(section, comparison)
    rate = 1000 / comparison[OURS]["median_ms"]
    section.numbers(["", "then", "now (two cores, software OpenGL)"], [["frames a second", "1 to 30 (O2)", f"{rate:.1f}"]])
    section.claim("interactive, one frame a second or more:", rate >= 1, f"{rate:.1f} frames a second.")
    claim_right(section, comparison, "flat facets exactly, the sphere beside them:")
    claim_better_than_environment(section, comparison)
    return section


def figure_scaling(shop):
    section = Section("Time against resolution (section 8)", "\"Our method scales much better than ray tracing to larger image resolutions, while ray tracing scales "
                      "better with scene depth complexity.\"")
    sizes = ("320x240", "640x480", "960x720", "1280x960")
    comparison = shop.compare("1998-scaling", "four-spheres", (PUBLISHED, OURS), "--sizes", ",".join(sizes))
    names = {PUBLISHED: "as published", OURS: "virtual objects", "raytrace": "ray tracer"}
    times = {method: [(s["width"] * s["height"] / 1e6, s["median_ms"]) for s in comparison[method]["sizes"]] for method in names}
    svg = charts.lines({names[method]: points for method, points in times.items()}, "megapixels", "frame, ms")
    section.strip([("frames of four-spheres", shop.keep("1998-scaling.svg", svg))])
    section.numbers(["", *sizes], [[names[m], *(milliseconds(ms) for _, ms in points)] for m, points in times.items()])
    growth = {method: points[-1][1] / points[0][1] for method, points in times.items()}
    section.claim("scales better than ray tracing, from the smallest to the largest picture:", growth[OURS] < growth["raytrace"],
                  f"sixteen times the pixels take {growth[OURS]:.1f} times as long, {growth[PUBLISHED]:.1f} as published, {growth['raytrace']:.1f} by rays.")
    return section
