# SPDX-License-Identifier: Apache-2.0
"""Ofek & Rappoport 1998, figures 4, 5, 10, 11, 13 and 14: what their method works with, and how fine it has to be."""
import sweep_scenes
from page import Section, px, share
from shop import mean_difference

COARSE = 2  # halvings of the octahedron: 128 triangles, as in the middle of their figure 13
PLANE = ("--eye", "0,0.51,2.0", "--target", "0,0.51,0", "--width", "4.2")
UNCUT = ("--max-error", "1e6")  # what is reflected stays as the scene has it cut


def make_scene(shop, halvings, cuts):
    name = f"ball-{halvings}-{cuts}.gltf"
    sweep_scenes.write_sweep(shop.path(name), halvings, cuts)
    return name


def figure_4(shop):
    section = Section("Figure 4: the reflection subdivision in the plane", "(a) Reflected rays (red) and hidden rays (blue) leave the corners of "
                      "the mirror; between them lie reflected and hidden cells, beyond the last ones the unreflected region, which a ray Z cuts in two. "
                      "(b) A point of a reflected cell is moved into the hidden cell behind the mirror.")
    scene = make_scene(shop, COARSE, 1)
    section.strip([("the cells, asked for at each pixel", shop.draw("1998-4a", scene, "subdivision", *PLANE, "--count", "40")),
                   ("two points and where they are drawn", shop.draw("1998-4b", scene, "subdivision", *PLANE, "--count", "40", "--point",
                                                                      "-0.6,0.5,0.9", "--point", "0.8,0.5,0.6"))])
    section.text("A ball of 128 triangles, cut by a plane through the eye (the black dot, left). Light: reflected cells, a colour a triangle. Dull: hidden "
                 "cells. Green: rays at right angles to the normal where the outline turns away from the eye, the paper's Z. Ours closes the region "
                 "behind them with the profile triangles, whose normals are turned until they are at right angles to the view, so that on a closed "
                 "mirror nothing is unreflected but slivers. (b): grey the view ray, red from the mirror to the point, blue to where the point is "
                 "drawn: on the view ray, as far behind the mirror as the point is before it.")
    section.text("A concave mirror's cells meet at its focus and overlap behind it:")
    section.strip([("the bowl of figures 8 and 11", shop.draw("1998-4c", "concave-bowl", "subdivision", "--eye", "0,1.41,0.2", "--target",
                                                              "0,1.41,-2", "--width", "4.6", "--count", "14", size="320x240"))])
    return section


def figure_5(shop):
    section = Section("Figure 5: an explosion map", "(a) Where reflected rays meet a sphere round the mirror. (b) These places as a map of directions in a "
                      "circle, a triangle of the mirror a triangle of the map; extension polygons fill the rest of the circle.")
    scene = make_scene(shop, COARSE, 1)
    section.strip([("rays and their sphere", shop.draw("1998-5a", scene, "mapping", *PLANE)),
                   ("near map, far map, hidden map", shop.draw("1998-5b", scene, "explosion-maps", *sweep_scenes.EYE))])
    section.text("The ball of 128 triangles. Dark: extension polygons, each in the colour of the profile triangle it belongs to. The far map is the mirror's "
                 "front spread over nearly all directions; what is left over is the shadow behind the mirror. Right: the hidden map, the mirror as the "
                 "eye sees it. Ids are whole numbers in ours; colours stand for them only here.")
    section.text("That 200 by 200 pixels are enough we did not try: our maps are 256 by 256, and `refined` takes from them only where its search starts.")
    return section


def figure_10(shop):
    section = Section("Figure 10: a reflected cell in space", "The cell of one triangle of the mirror: its sides are swept by the reflected rays of two "
                      "corners, so they are ruled surfaces, in general not planes.")
    scene = make_scene(shop, COARSE, 1)
    section.strip([("reflected cell red, hidden cell blue", shop.draw(
        "1998-10", scene, "cell", *sweep_scenes.EYE, "--point", "-0.5,0.9,1.0", "--from", "-2.6,1.5,1.6", "--at", "0,0.65,0.3", "--width", "1.3"))])
    section.text("Seen from a third eye. The yellow triangle of the mirror is the cell's end; grey the view rays through its corners, which go on as the "
                 "edges of the hidden cell. Lines that something hides show faintly.")
    return section


def figure_11(shop):
    section = Section("Figure 11: a concave mirror", "Left the picture; right the mirror, its reflected rays, a plane object and the virtual object from "
                      "another point of view; below the two explosion maps and the hidden map.")
    comparison = shop.compare("1998-11", "concave-bowl", ("virtual-explosion", "virtual-refined", "virtual-exact"))
    section.strip([comparison.picture("virtual-exact"), comparison.picture("raytrace"), comparison.error("virtual-exact", "error map")])
    section.strip([comparison.picture("virtual-explosion"), comparison.error("virtual-explosion", "its error map"),
                   comparison.picture("virtual-refined"), comparison.error("virtual-refined", "its error map")])
    section.strip([("rays of the bowl and virtual triangles, from aside", shop.draw(
        "1998-11-aside", "concave-bowl", "virtual-object", "--from", "2.3,2.5,-0.1", "--at", "0,1.4,-1.7", "--count", "14")),
                   ("its maps", shop.draw("1998-11-maps", "concave-bowl", "explosion-maps"))])
    section.numbers(*comparison.table())
    within = comparison.objects("virtual-exact", "share_le_1px")
    section.claim("concave mirrors are drawn exactly as convex ones, from one virtual vertex for each point:",
                  comparison.objects("virtual-refined", "share_le_1px") >= 0.99,
                  f"{share(comparison.objects('virtual-refined', 'share_le_1px'))} of the object pixels within 1 px so, "
                  f"{share(comparison.objects('virtual-explosion', 'share_le_1px'))} by explosion maps as published, {share(within)} where each pixel is tested.")
    return section


def figure_13(shop):
    section = Section("Figure 13: how fine the mirror", "The same picture with a mirror of 32, 128, 512 and 2048 triangles, and the maps of each. From 128 on "
                      "the reflection is about right; between 512 and 2048 there is hardly a difference.")
    pictures, errors, rows, pixels = [], [], [], {}
    for halvings in (1, 2, 3, 4):
        scene, count = make_scene(shop, halvings, 16), 8 * 4 ** halvings
        comparison = shop.compare(f"1998-13-{count}", scene, ("virtual-explosion", "virtual-refined"), *sweep_scenes.EYE, *UNCUT)
        pictures.append(comparison.picture("virtual-explosion", f"{count} triangles"))
        errors.append((f"maps of {count}", shop.draw(f"1998-13-{count}-maps", scene, "explosion-maps", *sweep_scenes.EYE)))
        pixels[count] = {m: shop.pixels(scene, *sweep_scenes.EYE, *UNCUT, "--method", "virtual", "--solver", m) for m in ("explosion", "refined")}
        rows.append([count, *(px(comparison.objects(m, "median_px")) for m in ("virtual-explosion", "virtual-refined"))])
    fine = make_scene(shop, 5, 16)
    pixels["truth"] = shop.pixels(fine, *sweep_scenes.EYE, "--method", "raytrace")
    truth, _ = shop.render("1998-13-truth", fine, *sweep_scenes.EYE, "--method", "raytrace")
    section.strip(pictures)
    section.strip([("ray-traced truth, 8192 triangles", truth)])
    section.strip(errors)
    off = {count: [mean_difference(pixels[count][m], pixels["truth"]) for m in ("explosion", "refined")] for count in (32, 128, 512, 2048)}
    for row in rows:
        row += [f"{value:.2f}" for value in off[row[0]]]
    section.numbers(["triangles", "median px as published", "median px, virtual objects", "mean difference from the truth with 8192, as published (of 255)",
                     "the same, virtual objects"], rows)
    together = shop.compare("1998-13-together", "reflector-sweep", ("virtual-explosion", "virtual-refined"))
    section.strip([together.picture("virtual-explosion", "the four in one scene, as published"), together.picture("virtual-refined"),
                   together.picture("raytrace"), together.error("virtual-explosion", "error map as published")])
    section.text("Displacements are against rays in the same triangles, differences against rays in the finest ball: the first says what the method adds, the "
                 "second what the facets cost as well.")
    for k, name in enumerate(("as published", "by virtual objects")):
        step = mean_difference(pixels[512][("explosion", "refined")[k]], pixels[2048][("explosion", "refined")[k]])
        first = mean_difference(pixels[32][("explosion", "refined")[k]], pixels[128][("explosion", "refined")[k]])
        section.claim(f"hardly a difference between 512 and 2048 triangles ({name}), less than a fifth of that between 32 and 128:", 5 * step < first,
                      f"the pictures differ by {step:.2f} of 255 on average, those of 32 and 128 by {first:.2f}.")
    return section


def figure_14(shop):
    section = Section("Figure 14: how fine the reflected object", "A mirror of 512 triangles; the object cut more and more finely. Seven by seven squares "
                      "are enough there, fewer for objects farther away.")
    pictures, rows, first = [], [], {}
    for cuts in (1, 3, 7, 15):
        scene = make_scene(shop, 3, cuts)
        comparison = shop.compare(f"1998-14-{cuts}", scene, ("virtual-explosion", "virtual-layered"), *sweep_scenes.EYE, *UNCUT)
        pictures.append(comparison.picture("virtual-layered", f"{cuts} x {cuts}"))
        first[cuts] = comparison.objects("virtual-layered", "median_px")
        rows.append([f"{cuts} x {cuts}", px(comparison.objects("virtual-explosion", "median_px")), px(first[cuts]),
                     share(comparison.objects("virtual-layered", "share_le_1px"))])
    section.strip([*pictures, comparison.picture("raytrace")])
    together = shop.compare("1998-14-together", "object-sweep", ("virtual-explosion", "virtual-layered"), "--max-error", "100")
    section.strip([together.picture("virtual-explosion", "1, 9, 49 and 225 cells, as published"), together.picture("virtual-layered"),
                   together.picture("raytrace"), together.error("virtual-layered", "error map of layered maps")])
    section.numbers(["object cut into", "median px as published", "median px, layered maps", "within 1 px, layered maps"], rows)
    section.text("Drawn with layered explosion maps: `refined` meets each pixel's ray with the real triangle, so that straight virtual edges do not show in it, "
                 "and the error of the method as published hides that of the cutting.")
    section.claim("7 x 7 is enough (a median of at most one pixel):", first[7] <= 1, f"median {px(first[7])} px; 15 x 15: {px(first[15])} px.")
    section.claim("and one square is not:", first[1] > 1, f"median {px(first[1])} px.")
    return section
