"""imgmesh-convert: what engines read, checked by their own rules."""
import json
import os
import xml.etree.ElementTree

import jsonschema
import numpy as np

import picture_files
from support import ROOT, CliCase, main


def area2(points):
    """Twice the area inside a polygon; positive if it runs counter-clockwise where y points up."""
    x, y = np.array(points).T
    return np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)


class Engines(CliCase):
    SHAPE = (48, 32)

    def setUp(self):
        """A ring with an island, and two squares that touch at a corner; its name has a space and an umlaut."""
        super().setUp()
        width, height = self.SHAPE
        pixels = picture_files.ramp(width, height)
        y, x = np.mgrid[:height, :width]
        radius = np.hypot(x - 16, y - 16)
        self.inside = ((radius < 14) & (radius > 7)) | (radius < 3)
        self.inside |= ((x >= 36) & (x < 40) & (y < 4)) | ((x >= 40) & (x < 44) & (y >= 4) & (y < 8))
        self.name = "mein Männchen"
        picture_files.png(self.folder / f"{self.name}.png", np.dstack([pixels, self.inside.astype(float)]))
        self.build(f"{self.name}.png", output="c.glb")

    def convert(self, output, *options, source="c.glb"):
        return self.report("imgmesh-convert", source, "-o", output, *options)

    def sprite(self):
        """The same mesh as PixiJS gets it: points from the image's corner, and triangles."""
        self.convert("s.json")
        (frame,) = json.loads((self.folder / "s.json").read_text())["frames"].values()
        return np.array(frame["vertices"]), np.array(frame["triangles"])

    def test_obj_with_texture(self):
        output = f"{self.name} 2.obj"
        report = self.convert(output, "--image", f"{self.name}.png")
        names = [output, f"{self.name} 2.mtl", f"{self.name} 2-texture.png"]
        self.assertEqual((report["outputs"], report["texture"]), (names, True))
        obj = (self.folder / output).read_text()
        self.assertIn(f"mtllib {names[1]}\nusemtl image\n", obj)
        mtl = (self.folder / names[1]).read_text()
        self.assertIn(f"map_Kd {names[2]}\nmap_d {names[2]}\n", mtl)
        numbers = {key: np.array([line.split()[1:] for line in obj.splitlines() if line.startswith(key + " ")])
                   for key in ("v", "vt", "f")}
        place, coords = numbers["v"].astype(float), numbers["vt"].astype(float)
        self.assertEqual(len(place), report["vertices"])
        self.assertEqual(len(numbers["f"]), report["faces"])
        self.assertEqual(place.shape[1], 3, "no colours beside a texture, which programs would multiply")
        width, height = self.SHAPE
        np.testing.assert_allclose(coords * [width, height], place[:, :2] + [0.5, height - 0.5], atol=1e-4)
        texture = picture_files.read(self.folder / names[2])
        self.assertEqual(texture.shape, (height, width, 4))
        self.assertTrue(((texture[..., 3] > 0.5) == self.inside).all())

    def test_obj_keeps_a_texture_and_leaves_it_out(self):
        self.run_ok("imgmesh-convert", "c.glb", "-o", "t.glb", "--texture", "--image", f"{self.name}.png", "-q")
        self.assertEqual(len(self.convert("t.obj", source="t.glb")["outputs"]), 3)
        self.assertNotIn("outputs", self.convert("u.obj", "--no-texture", source="t.glb"))
        self.assertNotIn("mtllib", (self.folder / "u.obj").read_text())
        # The image that the mesh was made from is not replaced, though it is named as the output.
        before = (self.folder / f"{self.name}.png").read_bytes()
        self.convert(f"{self.name}.obj", "--texture")
        self.assertEqual((self.folder / f"{self.name}.png").read_bytes(), before)

    def test_obj_is_whole_or_not_there(self):
        (self.folder / "x-texture.png").mkdir()
        self.assert_error("imgmesh-convert", ["c.glb", "-o", "x.obj", "--texture"], 3, "x-texture.png")
        os.rmdir(self.folder / "x-texture.png")
        (self.folder / "x.mtl").write_text("mine")
        self.assert_error("imgmesh-convert", ["c.glb", "-o", "x.obj", "--texture", "--no-overwrite"], 3, "x.mtl")

    def test_spine(self):
        """Hulls first, each one walk around its part; together exactly the mesh."""
        report = self.convert("spine.json", "--as", "spine", "--image", f"{self.name}.png")
        self.assertEqual(report["outputs"], ["spine.json", "spine.atlas"])
        width, height = self.SHAPE
        self.assertEqual((self.folder / "spine.atlas").read_text(),
                         f"{self.name}.png\nsize: {width}, {height}\nfilter: Linear, Linear\n{self.name}\n"
                         f"bounds: 0, 0, {width}, {height}\n")
        skeleton = json.loads((self.folder / "spine.json").read_text())
        self.assertEqual(skeleton["skeleton"]["images"], "./")
        (skin,) = skeleton["skins"]
        self.assertEqual([slot["name"] for slot in skeleton["slots"]], [f"{self.name}-{i}" for i in (1, 2, 3, 4)])
        total = 0
        for slot in skeleton["slots"]:
            mesh = skin["attachments"][slot["name"]][slot["attachment"]]
            self.assertEqual((mesh["type"], mesh["path"]), ("mesh", self.name))
            self.assertEqual((mesh["width"], mesh["height"]), self.SHAPE)
            points = np.array(mesh["vertices"]).reshape(-1, 2)
            uvs = np.array(mesh["uvs"]).reshape(-1, 2)
            np.testing.assert_allclose(points, (uvs - 0.5) * [width, -height], atol=1e-4)
            triangles = np.array(mesh["triangles"]).reshape(-1, 3)
            areas = [area2(points[t]) for t in triangles]
            self.assertGreater(min(areas), 0)
            hull = mesh["hull"]
            self.assertAlmostEqual(area2(points[:hull]), sum(areas), places=3)
            total += sum(areas)
            # Sides of triangles that no other runs back along are the hull, in its order.
            sides = {(t[i], t[(i + 1) % 3]) for t in triangles.tolist() for i in range(3)}
            self.assertEqual(len(sides), 3 * len(triangles))
            self.assertEqual({s for s in sides if s[::-1] not in sides}, {(i, (i + 1) % hull) for i in range(hull)})
            edges = {tuple(sorted(e)) for e in (np.array(mesh["edges"]).reshape(-1, 2) // 2).tolist()}
            self.assertEqual(edges, {tuple(sorted(s)) for s in sides})
        points, triangles = self.sprite()
        self.assertAlmostEqual(total, -sum(area2(points[t]) for t in triangles), places=2)

    def test_spine_of_a_few_pixels(self):
        for width, height in ((1, 1), (1, 7), (3, 2)):
            picture_files.png(self.folder / "odd.png", picture_files.noise(width, height))
            self.build("odd.png", "--density", "100", output="odd.glb")
            self.convert("odd.json", "--as", "spine", source="odd.glb")
            mesh = json.loads((self.folder / "odd.json").read_text())["skins"][0]["attachments"]["odd"]["odd"]
            self.assertEqual(area2(np.array(mesh["vertices"]).reshape(-1, 2)[:mesh["hull"]]), 2 * width * height)
            for kind in ("polygon2d", "meshinstance2d"):
                self.convert("odd.tscn", "--as", kind, source="odd.glb")
            self.convert("odd-outline.json", "--as", "outline", source="odd.glb")

    def test_godot(self):
        """What the text says; the test interop-godot draws it."""
        self.convert("x.tscn")
        text = (self.folder / "x.tscn").read_text()
        self.assertIn('path="x.png"', text)
        self.assertEqual(text.count('type="Polygon2D" parent="."'), 4)
        self.convert("x.tscn", "--as", "meshinstance2d", "--image", 'a "b".png')
        text = (self.folder / "x.tscn").read_text()
        self.assertIn(r'path="a \"b\".png"', text)
        points, triangles = self.sprite()
        self.assertIn(f'"vertex_count": {len(points)}\n', text)
        self.assertIn(f'"index_count": {3 * len(triangles)},\n', text)
        data = np.array(text.split('"array_data": PoolByteArray( ')[1].split(" )")[0].split(", "), np.uint8)
        vertices = data.view("<f4").reshape(-1, 4)
        np.testing.assert_allclose(vertices[:, :2], points, atol=1e-6)
        np.testing.assert_allclose(vertices[:, 2:] * self.SHAPE, points, atol=1e-4)

    def test_outlines(self):
        schema = json.loads((ROOT / "schemas" / "imgmesh-convert.outline.schema.json").read_text())
        areas = {}
        for tolerance in (None, 0, 1):
            options = [] if tolerance is None else ["--outline-tolerance", str(tolerance)]
            self.convert("o.json", "--as", "outline", *options)
            outline = json.loads((self.folder / "o.json").read_text())
            jsonschema.Draft202012Validator(schema).validate(outline)
            self.assertEqual((outline["width"], outline["height"]), self.SHAPE)
            area = 0
            for part in outline["parts"]:
                # y points down, so what is counter-clockwise on screen is negative.
                self.assertLess(area2(part["outer"]), 0)
                self.assertTrue(all(area2(hole) > 0 for hole in part["holes"]))
                area -= sum(area2(ring) for ring in [part["outer"], *part["holes"]]) / 2
            areas[tolerance] = area
            self.assertEqual(sorted(len(part["holes"]) for part in outline["parts"]), [0, 0, 0, 1])
            self.convert("o.svg", "--as", "outline", *options)
            root = xml.etree.ElementTree.fromstring((self.folder / "o.svg").read_text())
            self.assertEqual(root.get("viewBox"), "0 0 48 32")
            paths = root.findall("{http://www.w3.org/2000/svg}path")
            rings = [[[float(n) for n in point.split()] for point in ring.split("L")]
                     for path in paths for ring in path.get("d").removesuffix("Z").removeprefix("M").split("ZM")]
            self.assertEqual(rings, [ring for part in outline["parts"] for ring in [part["outer"], *part["holes"]]])
        self.assertEqual(areas[None], self.inside.sum())
        self.assertEqual(areas[0], self.inside.sum())
        self.assertGreater(areas[1], areas[0])

    def faces_of(self, name):
        """The corners of each level's faces, as sets of places."""
        document = json.loads((self.folder / f"{name}.gltf").read_text())
        data = (self.folder / f"{name}.bin").read_bytes()
        levels = []
        for mesh in document["meshes"]:
            (primitive,) = mesh["primitives"]

            def values(index, kind, width):
                accessor = document["accessors"][index]
                start = document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0)
                return np.frombuffer(data, kind, accessor["count"] * width, start).reshape(-1, width)

            place = values(primitive["attributes"]["POSITION"], "<f4", 3)
            corners = place[values(primitive["indices"], "<u4", 1).reshape(-1, 3)]
            levels.append(sorted(sorted(map(tuple, face)) for face in corners.tolist()))
        return levels

    def test_build_without_a_map(self):
        """The mesh is that of the same build with a map. (Draco would change the order in which vertices find their
        places at the pixels' edges.)"""
        picture_files.png(self.folder / "photo.png", picture_files.ramp(48, 32))
        for picture, options, name in ((f"{self.name}.png", [], "plain"), ("photo.png", ["--level-faces", "150,60"], "two")):
            report = self.build(picture, "--no-map", *options, output=f"{name}.gltf")
            self.assertNotIn("map_rms", report)
            self.assertEqual(report["layer_bytes"], 0)
            self.assertEqual(report["mesh_bytes"], (self.folder / f"{name}.bin").stat().st_size)
            self.assertEqual(report["bytes"], sum((self.folder / f"{name}.{end}").stat().st_size for end in ("gltf", "bin")))
            self.assertFalse((self.folder / f"{name}.exr").exists())
            whole = self.build(picture, "--draco", "none", *options, output="whole.glb")
            self.assertEqual([level["faces"] for level in report["levels"]], [level["faces"] for level in whole["levels"]])
            self.run_ok("imgmesh-convert", "whole.glb", "-o", f"converted {name}.gltf", "--no-map", "-q")
            self.assertEqual(self.faces_of(name), self.faces_of(f"converted {name}"))
            # Its colours are the best for what engines draw.
            self.assertLessEqual(report["gouraud_rms"], whole["gouraud_rms"] * 1.001)
        for tool in ("imgmesh-info", "imgmesh-compare"):
            self.assert_error(tool, ["plain.gltf"] + ["photo.png"] * (tool == "imgmesh-compare"), 4, "no pixel map")

    def test_build_without_a_map_and_what_needs_one(self):
        picture_files.png(self.folder / "photo.png", picture_files.ramp(48, 32))
        for options in (["--rms", "3"], ["--max-cluster", "100"], ["--map", "relaxed"], ["--bary", "half"], ["--visits"],
                        ["--projection-color-weight", "0.1"]):
            self.assert_error("imgmesh-build", ["photo.png", "-o", "x.glb", "--no-map", *options], 2, "--no-map", options[0])
        self.assert_error("imgmesh-build", ["photo.png", "-o", "x.glb", "--compression", "meshopt"], 2, "--no-map")
        sizes = {method: self.build("photo.png", "--no-map", "--compression", method, output=f"{method}.glb")["mesh_bytes"]
                 for method in ("none", "draco", "meshopt")}
        self.assertLess(sizes["draco"], sizes["none"])
        self.assertLess(sizes["meshopt"], sizes["none"])

    def test_a_warped_mesh_is_not_taken_for_the_image(self):
        """Its vertices have left the places where the image belongs."""
        self.run_ok("imgmesh-warp", "c.glb", "-o", "warped.glb", "--handle", "16,3:0.5,0.5")
        for output, *args in (("x.tscn",), ("x.json",), ("x.json", "--as", "spine"), ("x.obj", "--image", "c.png"),
                              ("x.glb", "--texture", "--image", "c.png")):
            self.assert_error("imgmesh-convert", ("warped.glb", "-o", output, *args), 5, "warped.glb", "imgmesh-warp")
        self.run_ok("imgmesh-convert", "warped.glb", "-o", "x.json", "--as", "outline")

    def test_wrong_use(self):
        for args, word in ((["-o", "x.glb", "--as", "spine"], "--as"), (["-o", "x.json", "--as", "polygon2d"], ".tscn"),
                           (["-o", "x.tscn", "--as", "spine"], ".json"), (["-o", "x.svg", "--as", "texturepacker"], ".json"),
                           (["-o", "x.svg", "--as", "outline", "--shading", "flat"], "--shading"),
                           (["-o", "x.json", "--as", "outline", "--image", "y.png"], "--image"),
                           (["-o", "x.json", "--as", "unity"], "texturepacker"), (["-o", "x.ply", "--texture"], "--texture"),
                           (["-o", "x.obj", "--image", "y.png", "--no-texture"], "--no-texture"),
                           (["-o", "x.svg", "--outline-tolerance", "1"], "--outline-tolerance"),
                           (["-o", "a\nb.obj", "--texture"], "control character"),
                           (["-o", "a\nb.json", "--as", "spine"], "control character")):
            self.assert_error("imgmesh-convert", ["c.glb", *args], 2, word)
        self.assert_error("imgmesh-convert", ["c.glb", "-o", "x.obj", "--image", "none.png"], 3, "none.png")


if __name__ == "__main__":
    main()
