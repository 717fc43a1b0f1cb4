# SPDX-License-Identifier: Apache-2.0
"""Bastos & Stuerzlinger 1998, figures 2 to 7, and their frame rates."""
import charts
from page import Section, milliseconds, px, share

BOX = ("--from", "3.4,3.3,2.6", "--at", "0,0.9,-0.4", "--from-fov", "46")
METHODS = ("environment-plain", "environment", "zexel")
EYES = ("0.85,1.62,1.5", "-0.9,1.3,1.3", "0.2,1.9,0.9")
LOOK = ("--target", "0,1.1,-1.5", "--fov", "64")


def figure_2(shop):
    section = Section("Figure 2: taking a traditional reflection map", "A cell in the middle of the scene; through each of its texels a solid angle, and the colour "
                      "of what is seen in it is kept on the cell's surface.")
    section.strip([("texels on the cell, the top left open", shop.draw("bastos-2", "checker-box", "reflection-cell", "--point", "0.1,1.75,0.35", "--width",
                                                                    "0.6", "--count", "8", *BOX))])
    section.text("Eight by eight texels a side, each the mean of what is seen through it; dashed, the directions of one ring of texels.")
    return section


def figure_3(shop):
    section = Section("Figure 3: using it", "The mirrored view ray of a pixel gives a direction, and nothing but its direction is looked up: the map answers as if the "
                      "mirror's point were the middle of the cell.")
    section.strip([("what a pixel should show black, what the map shows red", shop.draw("bastos-3", "checker-box", "mapped-rays", "--count", "5", *BOX))])
    section.text("Green the view rays, black what they meet over the mirror, red rays in the same directions from the middle of the map, which environment maps have in "
                 "the mirror's centre. The dots should coincide.")
    return section


def figure_4(shop):
    section = Section("Figure 4: taking a depth-preserving map", "Colour and depth of each texel: zexels do not lie on the cell, they float in front of what "
                      "they show.")
    section.strip([("zexels where they are, point and plane of projection orange", shop.draw("bastos-4", "checker-box", "zexels", "--count", "14", *BOX))])
    section.text("Every so many zexels of a reference image that was taken for this view. The image plane is the mirror itself, the point of projection one of 64 behind it. "
                 "Behind the pyramid and the teapot there are none: the point did not see it.")
    return section


def figure_5(shop):
    section = Section("Figure 5: using it", "Zexels are moved to where the mirrored eye sees them. Parts of the mirror that none reaches are exposures.")
    plain = ("--zexel-splat", "point", "--zexel-references", "1")
    bare = shop.draw("bastos-5-point", "checker-box", "exposures", *plain)
    points = dict(shop.facts)
    square = shop.draw("bastos-5-square", "checker-box", "exposures", "--zexel-splat", "square", "--zexel-references", "1")
    squares = dict(shop.facts)
    both = shop.draw("bastos-5-both", "checker-box", "exposures")
    section.strip([("one reference, a pixel a zexel", bare), ("one reference, 3 x 3 pixels", square), ("two references, footprints", both)])
    shares = [facts["exposures"] / facts["zexel_pixels"] for facts in (points, squares, shop.facts)]
    section.numbers(["", "exposed, share of the mirror"], list(zip(("one reference, points", "one reference, 3 x 3", "two references, footprints"),
                                                                map(share, shares))))
    section.text("Magenta: mirror pixels that no zexel reached, with the remedies that fill them by other means (the frame before, surfaces continued) switched off.")
    section.claim("splats of 3 x 3 and a second reference reduce exposures:", shares[1] < shares[0] and shares[2] < shares[0],
                  f"{share(shares[0])} become {share(shares[1])} and {share(shares[2])}.")
    return section


def claim_map(section, comparison, other="environment-plain"):
    zexel, plain = (comparison.objects(m, "median_px") for m in ("zexel", other))
    losses = [comparison.objects(m, "share_lost") for m in ("zexel", other)]
    text = "correct perspective and parallax where a traditional map has neither:"
    if other != "environment-plain":
        text = "better than a map corrected by the room's box, too, which the paper does not know:"
    section.claim(text, zexel < min(plain, 1) and losses[0] < losses[1],
                  f"median of object pixels {px(zexel)} px against {px(plain)} px, lost {share(losses[0])} against "
                  f"{share(losses[1])}.")


def figure_6(shop):
    section = Section("Figure 6: a teapot on a pyramid in a checkered box", "Left traditional reflection mapping, right zexels, one view a row: lines of the "
                      "checkerboard go on into the mirror only on the right. One map of 512 x 512, pictures of 640 x 480.")
    for k, eye in enumerate(EYES):
        comparison = shop.compare(f"bastos-6-{k + 1}", "checker-box", METHODS, "--eye=" + eye, *LOOK, "--zexel-references", "1")
        section.strip([comparison.picture("environment-plain"), comparison.picture("zexel"), comparison.picture("raytrace"),
                       comparison.error("zexel", "error map of zexels")])
        section.numbers(*comparison.table())
        claim_map(section, comparison)
    section.text("The time of these frames includes nothing that was prepared; exposures show the surface behind the edge, continued.")
    return section


def figure_7(shop):
    section = Section("Figure 7: a furnished room with two large mirrors", "189,982 polygons, two flat mirrors, up to 64 maps of 480 x 480 for each of which at most "
                      "two are used in a frame.")
    comparison = shop.compare("bastos-7", "furnished-room", METHODS, "--camera", "1", "--zexel-size", "480")
    section.strip([comparison.picture("environment-plain"), comparison.picture("zexel"), comparison.picture("raytrace"),
                   comparison.error("zexel", "error map of zexels")])
    section.numbers(*comparison.table())
    claim_map(section, comparison)
    claim_map(section, comparison, "environment")
    return section


def figure_rates(shop):
    section = Section("Frame rates (section 5)", "640 x 480 on an Onyx2 with InfiniteReality2. The box: 10 frames a second with mirrors, 15 with four processors, 60 "
                      "without the mirror. The room: 8.6, 12.9 with four processors, 15.9 without mirrors. The warp does not depend on the number of polygons.")
    rows, warps = [], {}
    then = {"checker-box": ("10 (15)", "60"), "furnished-room": ("8.6 (12.9)", "15.9")}
    for scene in then:
        shop.run("bench", scene, "--methods", "virtual-refined,zexel", "--size", "640x480", "--repeat", "5", "--json", "bench.json")
        timed = {row["name"]: row for row in shop.read_json("bench.json")["results"]}
        shop.run("bench", scene, "--methods", "none", "--no-reflectors", "--size", "640x480", "--repeat", "5", "--json", "bench.json")
        bare = shop.read_json("bench.json")["results"][0]["median_ms"]
        zexel, again = timed["zexel"]["median_ms"], timed["virtual-refined"]["median_ms"]
        warps[scene] = timed["zexel"]["warp_ms"]
        rows.append([scene, then[scene][0], f"{1000 / zexel:.1f}", f"{1000 / again:.1f}", then[scene][1], f"{1000 / bare:.1f}", milliseconds(warps[scene])])
        if scene == "furnished-room":
            section.claim("worthwhile where drawing the scene takes longer than warping:", zexel < again,
                          f"in the furnished room a frame with zexels takes {milliseconds(zexel)}, with the scene drawn again for each mirror {milliseconds(again)}.")
    section.numbers(["frames a second", "zexels then (four processors)", "zexels now", "scene drawn again now", "no mirrors then", "no mirrors now", "warp now"], rows)
    svg = charts.bars([(f"{row[0]}", float(row[2])) for row in rows], "frames a second with zexels, two cores, software OpenGL")
    section.strip([("frames a second", shop.keep("bastos-rates.svg", svg))])
    section.text("How a frame grows with the number of polygons, up to nine million, is measured by `scripts/zexel_scaling.py`, which takes longer than all pages here "
                 "together; the method's README has its table.")
    return section
