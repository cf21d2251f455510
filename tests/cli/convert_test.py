"""imgmesh-convert: the same image in every file variant, and exports that other programs read."""
import json
import xml.etree.ElementTree
import zipfile

import numpy as np
from PIL import Image

import picture_files
from support import CliCase, main


class Convert(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "in.png", picture_files.ramp(48, 32))
        self.build("in.png", "--level-faces", "200,60", output="c.glb")
        self.facts = self.report("imgmesh-info", "c.glb")

    def picture(self, name, level=0):
        self.run_ok("imgmesh-reconstruct", name, "-o", "drawn.ppm", "--level", level, "-q")
        return (self.folder / "drawn.ppm").read_bytes()

    def map_as_set(self, name):
        """What the pixel map says of each pixel, whatever the order of vertices, faces and corners: the image's own
        colours, and where in the mesh it lies."""
        return self.levels(name), self.picture(name), self.picture(name, 1)

    def levels(self, name):
        """The figures of all levels. Sums over faces differ in their last digits with the faces' order."""
        def rounded(value):
            if isinstance(value, dict):
                return {k: rounded(v) for k, v in value.items()}
            return float(f"{value:.9g}") if isinstance(value, float) else value
        return [rounded(level) for level in self.report("imgmesh-info", name)["levels"]]

    def test_bytes_are_those_of_all_files(self):
        for name, args in (("x.gltf", []), ("bare.gltf", ["--no-layers"]), ("y.glb", []), ("z.svg", [])):
            before = set(self.files())
            report = self.report("imgmesh-convert", "c.glb", "-o", name, *args)
            written = {path: len(data) for path, data in self.files().items() if path not in before}
            self.assertEqual(report["bytes"], sum(written.values()), name)
            self.assertEqual(sorted(report.get("outputs", [name])), sorted(written))
            if name.endswith("gltf"):  # whose parts are files of their own
                self.assertEqual(report["layer_bytes"], written.get(name.replace("gltf", "exr"), 0))
                padding = written[name.replace("gltf", "bin")] - report["mesh_bytes"]
                self.assertIn(padding, range(4 * report["levels"]))

    def test_round_trips_keep_the_map_exactly(self):
        before = self.map_as_set("c.glb")
        source = "c.glb"
        for i, (extension, draco) in enumerate([("gltf", "none"), ("gltf", "sequential"), ("glb", "none"),
                                                ("glb", "edgebreaker"), ("gltf", "edgebreaker")]):
            output = f"r{i}.{extension}"
            report = self.report("imgmesh-convert", source, "-o", output, "--draco", draco)
            self.assertEqual((report["levels"], report["layers"]), (2, True))
            self.assertEqual(self.map_as_set(output), before)
            facts = self.report("imgmesh-info", output)
            self.assertEqual((facts["draco"], facts["build"]), (draco, self.facts["build"]))
            self.assertEqual(self.report("imgmesh-info", output, "--validate")["findings"], [])
            source = output

    def test_the_file_variant_alone_keeps_everything(self):
        """Without options the compression stays what it is; edgebreaker's order comes back to itself after one round."""
        self.run_ok("imgmesh-convert", "c.glb", "-o", "a.gltf", "-q")
        self.assertEqual(self.report("imgmesh-info", "a.gltf")["draco"], "edgebreaker")
        self.run_ok("imgmesh-convert", "a.gltf", "-o", "b.glb", "-q")
        self.assertEqual(self.map_as_set("b.glb"), self.map_as_set("c.glb"))

    def test_levels(self):
        for levels, kept in (("0", [0]), ("1", [1]), ("0,1", [0, 1])):
            self.run_ok("imgmesh-convert", "c.glb", "-o", "k.glb", "--levels", levels, "-q")
            all_levels = self.levels("c.glb")
            self.assertEqual(self.levels("k.glb"), [all_levels[k] for k in kept])
            self.assertEqual(self.picture("k.glb"), self.picture("c.glb", kept[0]))

    def test_without_layers(self):
        for extension in ("glb", "gltf"):
            report = self.report("imgmesh-convert", "c.glb", "-o", f"m.{extension}", "--no-map")
            self.assertFalse(report["layers"])
            self.assert_error("imgmesh-info", [f"m.{extension}"], 4, "ext.missing")
            self.assertNotIn(b"IMGMESH", (self.folder / f"m.{extension}").read_bytes())
        self.assertEqual(sorted(f for f in self.files() if f.startswith("m.")), ["m.bin", "m.glb", "m.gltf"])
        mesh = json.loads((self.folder / "m.gltf").read_text())
        self.assertEqual(mesh["accessors"][0]["count"], 3 * self.facts["levels"][0]["faces"])
        # Without Draco, which some engines read as zeros; and the option's old name.
        self.assertNotIn("extensionsRequired", mesh)
        self.run_ok("imgmesh-convert", "c.glb", "-o", "old.glb", "--no-layers", "-q")
        self.assertEqual((self.folder / "old.glb").read_bytes(), (self.folder / "m.glb").read_bytes())

    def test_meshopt(self):
        """A plain mesh decodes to the same faces; the compressed file is far smaller."""
        size = {}
        for method in ("none", "draco", "meshopt"):
            self.run_ok("imgmesh-convert", "c.glb", "-o", f"{method}.gltf", "--no-map", "--compression", method, "-q")
            size[method] = (self.folder / f"{method}.bin").stat().st_size
        self.assertLess(size["meshopt"], 0.5 * size["none"])
        mesh = json.loads((self.folder / "meshopt.gltf").read_text())
        self.assertEqual(mesh["extensionsRequired"], ["EXT_meshopt_compression"])
        self.assertEqual(mesh["buffers"][1]["extensions"], {"EXT_meshopt_compression": {"fallback": True}})
        for accessor in mesh["accessors"]:
            view = mesh["bufferViews"][accessor["bufferView"]]
            inner = view["extensions"]["EXT_meshopt_compression"]
            self.assertEqual((view["buffer"], inner["buffer"]), (1, 0))
            self.assertEqual((inner["count"], inner["count"] * inner["byteStride"]), (accessor["count"], view["byteLength"]))
            self.assertLessEqual(view.get("byteOffset", 0) + view["byteLength"], mesh["buffers"][1]["byteLength"])
            self.assertLessEqual(inner.get("byteOffset", 0) + inner["byteLength"], mesh["buffers"][0]["byteLength"])
        self.assert_error("imgmesh-info", ["meshopt.gltf"], 4, "ext.missing", "no pixel map", "imgmesh-build")
        for tool, output in (("imgmesh-reconstruct", "x.png"), ("imgmesh-warp", "x.glb"), ("imgmesh-convert", "x.glb"),
                             ("imgmesh-segment", "x.png")):
            self.assert_error(tool, ["meshopt.gltf", "-o", output], 4, "no pixel map", "imgmesh-build")

    def test_svg(self):
        size = {}
        for shading in ("flat", "gradient"):
            self.run_ok("imgmesh-convert", "c.glb", "-o", "d.svg", "--shading", shading, "--level", "1", "-q")
            text = (self.folder / "d.svg").read_text()
            root = xml.etree.ElementTree.fromstring(text)
            paths = root.findall(".//{http://www.w3.org/2000/svg}path")
            self.assertEqual(len(paths), self.facts["levels"][1]["faces"])
            self.assertEqual(root.get("viewBox"), "-.5 -.5 48 32")
            if shading == "gradient":
                gradients = {g.get("id"): g for g in root.iter("{http://www.w3.org/2000/svg}linearGradient")}
                self.assertEqual({p.get("fill") for p in paths}, {f"url(#{name})" for name in gradients})
                self.assertNotIn("nan", text)
            size[shading] = len(text)
        self.assertGreater(size["gradient"], size["flat"])

    def test_ply_and_obj(self):
        self.run_ok("imgmesh-convert", "c.glb", "-o", "d.ply", "-q")
        self.run_ok("imgmesh-convert", "c.glb", "-o", "d.obj", "-q")
        level = self.facts["levels"][0]
        lines = (self.folder / "d.ply").read_text().splitlines()
        start = lines.index("end_header") + 1
        self.assertIn(f"element vertex {level['vertices']}", lines)
        vertices = [line.split() for line in lines[start:start + level["vertices"]]]
        faces = [tuple(int(i) for i in line.split()[1:]) for line in lines[start + level["vertices"]:]]
        self.assertEqual(len(faces), level["faces"])
        x = np.array([[float(v[0]), float(v[1])] for v in vertices])
        edges = x[[f[1] for f in faces]] - x[[f[0] for f in faces]], x[[f[2] for f in faces]] - x[[f[0] for f in faces]]
        area = edges[0][:, 0] * edges[1][:, 1] - edges[0][:, 1] * edges[1][:, 0]
        self.assertTrue((area > 0).all(), "a face is turned over")
        self.assertEqual(area.sum() / 2, 48 * 32, "whole pixels, not only from centre to centre")
        text = (self.folder / "d.obj").read_text().splitlines()
        positions = [line.split()[1:3] for line in text if line.startswith("v ")]
        self.assertEqual(positions, [v[:2] for v in vertices])
        self.assertEqual([tuple(int(i.split("/")[0]) - 1 for i in line.split()[1:]) for line in text if line.startswith("f ")],
                         faces)
        for line in (line for line in text if line.startswith("vt ")):
            self.assertTrue(all(0 <= float(i) <= 1 for i in line.split()[1:]))

    def test_sprite(self):
        self.run_ok("imgmesh-convert", "c.glb", "-o", "d.json", "-q")
        sheet = json.loads((self.folder / "d.json").read_text())
        frame = sheet["frames"]["d.png"]
        self.assertEqual(sheet["meta"]["image"], "d.png")
        self.assertEqual(sheet["meta"]["size"], {"w": 48, "h": 32})
        points = np.array(frame["vertices"])
        self.assertEqual((points.min(axis=0).tolist(), points.max(axis=0).tolist()), ([0, 0], [48, 32]))
        self.assertEqual(frame["vertices"], frame["verticesUV"])
        self.assertEqual(len(frame["triangles"]), self.facts["levels"][0]["faces"])
        self.assertLess(max(max(t) for t in frame["triangles"]), len(points))
        for kind in ("d.json", "d.tscn"):
            self.assertIn("hero.png, which is not beside it",
                          self.run_tool("imgmesh-convert", "c.glb", "-o", kind, "--image", "hero.png", "-q").stderr)
        self.run_ok("imgmesh-convert", "c.glb", "-o", "-", "--format", "json", "--image", "hero.png", "-q")
        picture_files.png(self.folder / "hero.png", picture_files.ramp(48, 32))
        self.run_ok("imgmesh-convert", "c.glb", "-o", "d.json", "--image", "hero.png", "-q")
        self.assertIn("hero.png", json.loads((self.folder / "d.json").read_text())["frames"])

    def test_face_ids(self):
        """The ids drawn are those of the layers."""
        self.run_ok("imgmesh-convert", "c.glb", "-o", "d.png", "-q")
        drawn = np.round(picture_files.read(self.folder / "d.png") * 255).astype(int)
        ids = drawn[..., 0] + 256 * drawn[..., 1] + 65536 * drawn[..., 2]
        self.assertLess(ids.max(), self.facts["levels"][0]["faces"])
        self.assertGreater(len(np.unique(ids)), 50)
        import OpenImageIO as oiio
        self.run_ok("imgmesh-convert", "c.glb", "-o", "d.gltf", "-q")
        # Edgebreaker's order is settled after one round, so the ids are comparable.
        self.run_ok("imgmesh-convert", "d.gltf", "-o", "e.png", "-q")
        drawn = np.round(picture_files.read(self.folder / "e.png") * 255).astype(int)
        layers = oiio.ImageInput.open(str(self.folder / "d.exr"))
        index = layers.spec().channelnames.index("face.id")
        stored = layers.read_image(0, 0, index, index + 1, "uint")[..., 0]
        self.assertTrue((drawn[..., 0] + 256 * drawn[..., 1] + 65536 * drawn[..., 2] == stored).all())

    def test_odd_sizes(self):
        for width, height in ((1, 1), (1, 7), (3, 3)):
            picture_files.png(self.folder / "odd.png", picture_files.noise(width, height))
            self.build("odd.png", "--density", "100", output="odd.glb")
            for extension in ("svg", "ply", "obj", "json", "png", "gltf"):
                self.run_ok("imgmesh-convert", "odd.glb", "-o", f"odd-out.{extension}", "-q")
            self.run_ok("imgmesh-convert", "odd.glb", "-o", "odd-out.svg", "--shading", "gradient", "-q")

    def test_the_input_stays_whole(self):
        """x.gltf is replaced; its files belong to the input as well, and stay."""
        self.run_ok("imgmesh-convert", "c.glb", "-o", "x.gltf", "-q")
        (self.folder / "y.gltf").write_bytes((self.folder / "x.gltf").read_bytes())
        self.run_ok("imgmesh-convert", "y.gltf", "-o", "x.gltf", "--levels", "0", "-q")
        for name in ("x.gltf", "y.gltf"):
            self.run_ok("imgmesh-reconstruct", name, "-o", "r.png", "-q")

    def test_wrong_use(self):
        wrong = [(["-o", "x.docx"], "x.docx"), (["-o", "x"], "expected"), (["-o", "x.glb", "--levels", "2"], "--levels"),
                 (["-o", "x.glb", "--levels", "1,0"], "--levels"), (["-o", "x.glb", "--levels", "0,0"], "--levels"),
                 (["-o", "x.glb", "--levels", ""], "--levels"), (["-o", "x.glb", "--level", "0"], "--level"),
                 (["-o", "x.svg", "--level", "2"], "--level"), (["-o", "x.svg", "--level", "-1"], "--level"),
                 (["-o", "x.svg", "--draco", "none"], "--draco"), (["-o", "x.ply", "--no-map"], "--no-map"),
                 (["-o", "x.glb", "--compression", "meshopt"], "--no-map"), (["-o", "x.ply", "--compression", "none"], "container"),
                 (["-o", "x.glb", "--compression", "draco", "--draco", "none"], "--draco"),
                 (["-o", "x.ply", "--levels", "0"], "--levels"), (["-o", "x.png", "--shading", "flat"], "--shading"),
                 (["-o", "x.svg", "--shading", "smooth"], "gradient"), (["-o", "x.png", "--image", "y"], "--image"),
                 (["-o", "c.glb"], "input"), (["-o", "x.glb", "--draco", "zip"], "edgebreaker")]
        for args, word in wrong:
            self.assert_error("imgmesh-convert", ["c.glb", *args], 2, word)
        self.assert_error("imgmesh-convert", ["c.glb", "-o", "x.glb", "--max-pixels", "10"], 4, "limits.pixels")
        self.assert_error("imgmesh-convert", ["in.png", "-o", "x.glb"], 4, "in.png")

    def test_arrays_for_numpy(self):
        """With the arrays alone the reconstruction is the tool's, in L*u*v*; Python's zipfile finds every sum right."""
        picture_files.png(self.folder / "soft.png", np.concatenate([picture_files.ramp(40, 20), np.linspace(
            0, 1, 800).reshape(20, 40, 1)], axis=-1))
        self.build("soft.png", "--density", "20", "--visits", output="soft.glb")
        for container, level, names in (("c.glb", 0, b"R G B"), ("c.glb", 1, b"R G B"), ("soft.glb", 0, b"R G B A")):
            self.run_ok("imgmesh-convert", container, "-o", "a.npz", "-q", "--level", level)
            with zipfile.ZipFile(self.folder / "a.npz") as file:
                self.assertIsNone(file.testzip())
            arrays = np.load(self.folder / "a.npz")
            channels = len(names.split())
            facts = self.report("imgmesh-info", container)
            height, width = facts["height"], facts["width"]
            v, f = facts["levels"][level]["vertices"], facts["levels"][level]["faces"]
            expected = {"vertices": ("f4", (v, 2)), "faces": ("u4", (f, 3)), "features": ("f4", (v, channels)),
                        "colors": ("f4", (v, 3)), "face_ids": ("u4", (height, width)),
                        "barycentrics": ("f4", (height, width, 2)), "channel_names": ("S1", (channels,))}
            if container == "soft.glb":
                expected["visits"] = ("u4", (height, width))
            self.assertEqual({n: (arrays[n].dtype.str.lstrip("<|"), arrays[n].shape) for n in arrays.files}, expected)
            self.assertEqual(b" ".join(arrays["channel_names"]), names)
            inside = arrays["face_ids"] != 0xFFFFFFFF
            faces = np.where(inside, arrays["face_ids"], 0)
            corners = arrays["features"][arrays["faces"][faces]]
            u, w = arrays["barycentrics"][..., :1], arrays["barycentrics"][..., 1:]
            drawn = (1 - u - w) * corners[..., 0, :] + u * corners[..., 1, :] + w * corners[..., 2, :]
            self.run_ok("imgmesh-reconstruct", container, "-o", "drawn.png", "-q", "--level", level)
            rgb = np.asarray(Image.open(self.folder / "drawn.png")) / 255  # OpenImageIO would multiply alpha in
            linear = np.where(rgb[..., :3] <= 0.04045, rgb[..., :3] / 12.92, ((rgb[..., :3] + 0.055) / 1.055) ** 2.4)
            lightness = 116 * np.cbrt(linear @ [0.2126, 0.7152, 0.0722]) - 16
            self.assertLess(np.abs(lightness - drawn[..., 0])[inside].max(), 1)
            if channels == 4:
                self.assertLess(np.abs(rgb[..., 3] - drawn[..., 3])[inside].max(), 0.003)
                self.assertEqual(rgb[~inside][:, 3].sum(), 0)

    def test_arrays_of_odd_containers(self):
        picture_files.png(self.folder / "one.png", picture_files.ramp(1, 1))
        self.build("one.png", output="one.glb")
        self.run_ok("imgmesh-convert", "one.glb", "-o", "one.npz", "-q")
        self.assertEqual(np.load(self.folder / "one.npz")["face_ids"].shape, (1, 1))
        picture_files.write_float(self.folder / "heights.exr", picture_files.noise(9, 7, 1), names=["height"])
        self.build("heights.exr", "--values", output="heights.glb")
        self.run_ok("imgmesh-convert", "heights.glb", "-o", "heights.npz", "-q")
        arrays = np.load(self.folder / "heights.npz")
        self.assertNotIn("colors", arrays.files)
        self.assertEqual((arrays["channel_names"].tolist(), arrays["features"].shape[1]), ([b"height"], 1))
        self.assert_error("imgmesh-convert", ["c.glb", "-o", "x.npz", "--draco", "none"], 2, "--draco", "x.npz")
        self.assert_error("imgmesh-convert", ["c.glb", "-o", "x.npz", "--level", "7"], 2, "--level 7")


if __name__ == "__main__":
    main()
