# SPDX-License-Identifier: Apache-2.0
"""Martin & Popescu 2004, figures 1 and 8, and its figures in numbers."""
import charts
from page import Section, px, share


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


def figure_3(shop):
    section = Section("Figure 3: the generalised camera", "A camera and two reflectors together: a list of ray segments, from the camera to the first "
                      "reflector, on to the second, and out of the scene. A point of the scene may be near several of them.")
    options = ("--bounces", "2", "--from", "0.2,4.2,3.4", "--at", "0,1.0,-0.2")
    section.strip([("grey, red, blue: before the first mirror, behind it, behind the second",
                    shop.draw("2004-3", "facing-mirrors", "camera-rays", *options, "--from-fov", "44", "--count", "16")),
                   ("what the camera sees, two bounces", shop.render("2004-3-picture", "facing-mirrors", "--method", "raytrace", "--bounces", "2")[0])])
    section.text("Rays of the middle row of the picture, by the tracer that bakes. Where a ray of one row of pixels ends on the left and another on the right, one "
                 "scene point has several images: morphing keeps one for each trace, a sequence of mirrors.")
    comparison = shop.compare("2004-3-facing", "facing-mirrors", ("environment", "virtual-refined", "morphing"), "--bounces", "2")
    section.strip(comparison.beside_truth("morphing"))
    section.numbers(*comparison.table())
    within = comparison.objects("morphing", "share_le_1px")
    section.claim("the method can be extended to higher order reflections (section 9, future work there):", within >= 0.95,
                  f"two bounces between curved mirrors: {share(within)} of the object pixels within 1 px.")
    return section


def figure_5(shop):
    section = Section("Figure 5: morphing a vertex", "The box is the sampling cell of the viewer; from each of its eight corners it is known in which point of "
                      "the reflector a vertex is seen, and these eight points are interpolated.")
    section.strip([("cell, corners and their mirror points orange, interpolated point black", shop.draw(
        "2004-5", "columns", "sampling-cell", "--point", "0.75,0.55,0.55", "--spacing", "0.7", "--from", "2.9,3.0,3.1", "--at", "0,0.85,1.2")),
                   ("the ray octree of one corner, the leaf of the vertex red", shop.draw(
                       "2004-5-octree", "columns", "ray-octree", "--point", "0.75,0.55,0.55", "--spacing", "0.7", "--from", "2.4,3.0,2.6", "--at", "0.2,0.5,0.4",
                       "--from-fov", "34"))])
    facts = shop.facts
    section.text("The cell is drawn 0.7 m wide; the method would choose a tenth of that here. Red: mirror point to vertex; blue: where the vertex is drawn. "
                 f"Octree of 256 by 256 rays, depth 5: {facts['leaves']} leaves, {facts['rays'] / facts['leaves']:.1f} rays in a leaf on average, at most "
                 f"{facts['most_rays']}. One leaf's rays are drawn from the corner over the mirror into the leaf.")
    return section


def figure_6(shop):
    section = Section("Figure 6: the reflection mesh", "The triangles between morphed vertices, drawn over the picture.")
    section.strip([("triangles as morphing draws them", shop.draw("2004-6", "columns", "reflection-mesh", "--spacing", "0.1", "--max-error", "4")),
                   ("the same view", shop.render("2004-6-picture", "columns", "--method", "morphing")[0])])
    section.text(f"{shop.facts['virtual_triangles']} triangles at a bound of 4 px, so that they can be seen; a colour for each object. Their edges end outside of the "
                 "mirror's outline, where the map is continued, and the mirror's own depth cuts them.")
    return section


def figure_7(shop):
    section = Section("Figure 7: pushing the point along the ray", "The interpolated mirror point is pushed along the ray from the viewer by the distance between it "
                      "and the scene vertex, so that the depth buffer orders reflections by how far they are from the reflector.")
    section.strip([("as long behind the mirror (blue) as before it (red)", shop.draw(
        "2004-7", "columns", "sampling-cell", "--point", "0.75,0.55,0.55", "--spacing", "0.1", "--from", "0.2,3.2,0.9", "--at", "0.15,0.5,0.65", "--from-fov", "46"))])
    section.text("From above. The pushed point lies on the viewer's ray, so its place in the picture is that of the mirror point; only its depth is new. "
                 "Ours interpolates the length of the path as well, which makes the same true behind several mirrors.")
    return section


def figure_numbers(shop):
    section = Section("Figures in numbers (section 8)", "20,000 dynamic and 200,000 static vertices a second on a Pentium 4 at 2 GHz. At 256 x 256 rays, octree depth 5 "
                      "and one bounce: 4.1 to 5.4 MB for a sampling location, 10.4 to 13.5 rays in a leaf on average, 227 to 353 at most, about 3 minutes.")
    shop.run("bake", "columns", "-o", "columns.bake", "--box=-0.3,0.9,2.1,0.3,1.3,2.5", "--counts", "3x3x3", "--rays", "256", "--depth", "5", "--json", "bake.json")
    locations = shop.read_json("bake.json")["locations"]
    shop.run("bench", "drivers-view", "--methods", "morphing,morphing-dynamic", "--repeat", "5", "--size", "640x480", "--json", "bench.json")
    rows = {row["name"]: row for row in shop.read_json("bench.json")["results"]}
    kept, moving = rows["morphing"]["static_vertices_per_s"], rows["morphing-dynamic"]["dynamic_vertices_per_s"]
    megabytes = [location["bytes"] / 1e6 for location in locations]
    leaf = [location["mean_leaf_rays"] for location in locations]
    seconds = sum(location["seconds"] for location in locations) / len(locations)
    section.numbers(["", "then (Pentium 4, 2 GHz)", "now (two cores)"], [
        ["dynamic vertices a second", "20,000", f"{moving:,.0f}"], ["static vertices a second", "200,000", f"{kept:,.0f}"],
        ["megabytes a location", "4.1 to 5.4", f"{min(megabytes):.2f} to {max(megabytes):.2f}"],
        ["rays in a leaf on average", "10.4 to 13.5", f"{min(leaf):.1f} to {max(leaf):.1f}"],
        ["most rays in a leaf", "227 to 353", f"{max(location['most_leaf_rays'] for location in locations)}"],
        ["seconds a location", "about 180", f"{seconds:.2f}"]])
    svg = charts.bars([("dynamic, then", 20000), ("dynamic, now", moving), ("static, then", 200000), ("static, now", kept)], "vertices a second")
    section.strip([("vertices a second", shop.keep("2004-numbers.svg", svg))])
    section.claim("static vertices are ten times cheaper than dynamic ones:", kept >= 10 * moving, f"{kept / moving:.0f} times here.")
    return section
