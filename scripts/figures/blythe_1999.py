# SPDX-License-Identifier: Apache-2.0
"""Blythe 1999, figures 61 to 64: explosion maps explained once more, with the right factor."""
from ofek_rappoport_1998_structures import COARSE, PLANE, make_scene
import sweep_scenes
from page import Section, px

POINT = ("--point", "-0.75,0.51,0.75")


def figure_61(shop):
    section = Section("Figure 61: a reflected ray as a place in the map", "The view ray V meets the reflector in P; the reflected ray R meets a sphere "
                      "round the reflector, and the direction D from the sphere's centre to that place is what is mapped into the circle.")
    section.strip([("V black, R red, D blue", shop.draw("1999-61", make_scene(shop, COARSE, 1), "mapping", *PLANE))])
    section.text("D and R are not parallel: the map depends on the sphere's radius, and that is why there have to be two. Blythe's formula, s = r/2 (1 + x / "
                 "sqrt(2 (z + 1))), is the one we use; the 1998 text misprints the factor. Our map's z axis points to the eye, so that its singular direction "
                 "lies in the shadow.")
    return section


def figure_62(shop):
    section = Section("Figure 62: ids of triangles in an explosion map", "An explosion map in which each triangle has a colour that stands for its number.")
    section.strip([("near map, far map, hidden map of 128 triangles", shop.draw("1999-62", make_scene(shop, COARSE, 1), "explosion-maps",
                                                                              *sweep_scenes.EYE)),
                   ("of an open fender, whose edges are extended", shop.draw("1999-62-open", "fender", "explosion-maps"))])
    section.text("The fender has no back faces: what would be extension polygons is a skirt of triangles that goes on past its edges (Blythe's rule for "
                 "surfaces that are not solid).")
    return section


def figure_63(shop):
    section = Section("Figure 63: from the map to the reflecting triangle", "A vertex that lies on the sphere: its direction gives a triangle and "
                      "barycentric coordinates, these a point and a normal, and the vertex is mirrored in the plane there.")
    section.strip([("the near map's answer orange, the right one green", shop.draw("1999-63", make_scene(shop, COARSE, 1), "near-look-up", *PLANE, *POINT))])
    section.text("Red: the vertex. Orange: the direction that is asked (dashes), the near sphere, the plane that the map names and the vertex mirrored in it. "
                 "Green: where the eye does see it, and where it has to be drawn. The vertex is not on the near sphere, so the map is off; see figure 64.")
    return section


def figure_64(shop):
    section = Section("Figure 64: near and far map together", "Neither map's triangle may be right for a vertex between the spheres; the two virtual "
                      "vertices are weighted by the distances of the vertex from the spheres.")
    section.strip([("near orange, far violet, blended blue, right green", shop.draw("1999-64", make_scene(shop, COARSE, 1), "look-up", *PLANE, *POINT))])
    comparison = shop.compare("1999-64-ball", make_scene(shop, 4, 16), ("environment", "virtual-explosion", "virtual-layered", "virtual-refined"),
                              *sweep_scenes.EYE)
    section.numbers(*comparison.table())
    two, many = (comparison.objects(m, "median_px") for m in ("virtual-explosion", "virtual-layered"))
    section.claim("two maps give a good approximation, 2 px or less:", two <= 2, f"on a ball of 2048 triangles the median is {px(two)} px; more layers, "
                  f"and blending the reflection point instead of the virtual vertex, give {px(many)} px.")
    mapped = comparison.objects("environment", "median_px")
    section.claim("and a better one than an environment map:", two < mapped, f"{px(two)} px against {px(mapped)} px.")
    return section
