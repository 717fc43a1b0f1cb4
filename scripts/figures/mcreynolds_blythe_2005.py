# SPDX-License-Identifier: Apache-2.0
"""McReynolds & Blythe 2005, section 17.1.2: ways to keep what a flat mirror shows within the mirror, side by side."""
import charts
from page import Section, milliseconds, share
from shop import mean_difference

WAYS = {"ids": "ids of mirrors, looked up (ours)", "stencil": "stencil, masked first", "erase": "stencil, erased afterwards", "depth": "depth (figure 17.3)",
        "clip": "clip planes", "texture": "projective texture (figure 17.4)"}
SCENE = "checker-box"


def compare_pixels(shop, scene, ways, *options):
    """Mean difference of each way's picture from that by ids, of 255."""
    pixels = {way: shop.pixels(scene, "--method", "virtual", "--merge", way, *options) for way in ("ids", *ways)}
    return {way: mean_difference(pixels["ids"], pixels[way]) for way in ways}


def figure_17_3(shop):
    section = Section("Figure 17.3: masking by depth", "What is not reflected is drawn first; its depths keep mirrored things from being drawn beyond the mirror's edge, as long "
                      "as something surrounds the mirror.")
    section.strip([(WAYS[way], shop.render(f"2005-17_3-{way}", SCENE, "--method", "virtual", "--merge", way)[0]) for way in ("depth", "ids")])
    off = compare_pixels(shop, SCENE, ["depth"])["depth"]
    section.claim("depth values alone mask the reflection:", off < 0.5, f"the picture differs from that by ids by {off:.4f} of 255 on average.")
    section.text("Ours makes all pixels but the mirror's the nearest, so it needs nothing that surrounds the mirror; the text's own variant leaks there.")
    return section


def figure_17_4(shop):
    section = Section("Figure 17.4: masking by a projective texture", "The view without the mirror; the mirrored view as a texture; the mirror with that texture, its "
                      "coordinates those of the window. It may be drawn at a lower resolution, which blurs it.")
    section.strip([("without the mirror", shop.render("2005-17_4-bare", SCENE, "--method", "none", "--no-reflectors")[0]),
                   ("texture of full size", shop.render("2005-17_4-full", SCENE, "--method", "virtual", "--merge", "texture")[0]),
                   ("a quarter of the size", shop.render("2005-17_4-quarter", SCENE, "--method", "virtual", "--merge", "texture", "--texture-scale", "0.25")[0]),
                   ("ray-traced truth", shop.render("2005-17_4-truth", SCENE, "--method", "raytrace")[0])])
    full = compare_pixels(shop, SCENE, ["texture"])["texture"]
    coarse = mean_difference(shop.pixels(SCENE, "--method", "virtual"), shop.pixels(SCENE, "--method", "virtual", "--merge", "texture", "--texture-scale", "0.25"))
    section.claim("the texture registers with the window:", full < 0.5, f"mean difference from ids {full:.3f} of 255.")
    section.claim("a coarser texture blurs:", coarse > full, f"mean difference {coarse:.2f} of 255 at a quarter of the size.")
    return section


def figure_masking(shop):
    section = Section("All ways side by side", "Clip planes are \"the highest-performance approach for many implementations\"; erasing \"may be the higher performance option\" "
                      "against masking first, but \"doesn't work well if interreflections are required\".")
    scene, bounces = "hall-of-mirrors", ("--bounces", "2")
    shown = [(text, shop.render(f"2005-{way}", scene, "--method", "virtual", "--merge", way, *bounces)[0]) for way, text in WAYS.items()]
    section.strip(shown[:3])
    section.strip(shown[3:])
    comparison = shop.compare("2005-truth", scene, ("virtual-refined",), *bounces)
    section.strip([comparison.picture("raytrace"), comparison.error("virtual-refined", "error map, by ids")])
    off = compare_pixels(shop, scene, list(WAYS)[1:], *bounces)
    times = {}
    for timed in ("hall-of-mirrors", "furnished-room"):
        methods = ",".join("virtual-refined" + ("" if way == "ids" else "+" + way) for way in WAYS)
        shop.run("bench", timed, "--methods", methods, "--size", "640x480", "--repeat", "5", "--json", "bench.json")
        times[timed] = dict(zip(WAYS, (row["reflection_ms"] for row in shop.read_json("bench.json")["results"])))
    section.numbers(["way", "mean difference from ids, of 255", *(f"reflections of {name}, 640x480" for name in times)],
                    [[text, "–" if way == "ids" else f"{off[way]:.4f}", *(milliseconds(t[way]) for t in times.values())] for way, text in WAYS.items()])
    svg = charts.bars([(way, times["furnished-room"][way]) for way in WAYS], "reflections of furnished-room, ms (software OpenGL)")
    section.strip([("time of each way", shop.keep("2005-times.svg", svg))])
    within = comparison.objects("virtual-refined", "share_le_1px")
    section.claim("a flat mirror's picture is exact:", within >= 0.999, f"{share(within)} of the object pixels within 1 px of the truth, two bounces.")
    worst = max(off.values())
    section.claim("all ways show the same:", worst < 0.5, f"the largest mean difference from ids is {worst:.4f} of 255.")
    section.claim("erasing afterwards does not work well for mirrors in mirrors:", off["erase"] > 0.5,
                  f"ours gives each mirror a value of its own and differs from ids by {off['erase']:.4f} of 255 in a hall of mirrors.")
    fastest = {name: min(t, key=t.get) for name, t in times.items()}
    section.claim("clip planes are the fastest:", set(fastest.values()) == {"clip"},
                  "fastest here: " + ", ".join(f"{way} ({name})" for name, way in fastest.items()) + ". Five frames each, in turn; differences of a few "
                  "milliseconds are noise in software.")
    return section
