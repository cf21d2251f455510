"""--texture: an image on the meshes, for engines."""
import io
import json
import struct

import numpy as np
from PIL import Image

import picture_files
from support import CliCase, main


def asset(path):
    """The document, and the bytes of its buffer."""
    data = path.read_bytes()
    if data[:4] != b"glTF":
        document = json.loads(data)
        return document, (path.parent / document["buffers"][0]["uri"]).read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + length]), data[28 + length:]


def texture_file(path):
    """The bytes of the texture's file; None without one."""
    document, buffer = asset(path)
    if "images" not in document:
        return None
    (image,) = document["images"]
    view = document["bufferViews"][image["bufferView"]]
    start = view.get("byteOffset", 0)
    return buffer[start:start + view["byteLength"]]


def texture_of(path):
    """Height x width x channels, 0 to 255."""
    return np.asarray(Image.open(io.BytesIO(texture_file(path))))


class Texture(CliCase):
    def setUp(self):
        super().setUp()
        self.picture = np.round(picture_files.ramp(48, 32) * 255)
        picture_files.png(self.folder / "in.png", self.picture / 255)
        self.build("in.png", "--level-faces", "200,60", output="plain.glb")

    def drawn(self, name, level):
        self.run_ok("imgmesh-reconstruct", name, "-o", "drawn.png", "--level", level, "-q")
        return picture_files.read(self.folder / "drawn.png")

    def assert_same_maps(self, name, other):
        for level in (0, 1):
            self.assertTrue((self.drawn(name, level) == self.drawn(other, level)).all())

    def assert_valid(self, name):
        self.assertEqual(self.report("imgmesh-info", name, "--validate")["findings"], [])

    def test_build_and_convert_put_the_same_picture_on(self):
        self.build("in.png", "--level-faces", "200,60", "--texture", output="t.glb")
        self.report("imgmesh-convert", "plain.glb", "-o", "c.glb", "--texture", "--image", "in.png")
        self.assertEqual(texture_file(self.folder / "t.glb"), texture_file(self.folder / "c.glb"))
        self.assertTrue((texture_of(self.folder / "t.glb") == self.picture).all())
        self.assert_valid("t.glb")
        self.assert_same_maps("t.glb", "plain.glb")
        document, _ = asset(self.folder / "t.glb")
        (material,) = document["materials"]
        self.assertIn("KHR_materials_unlit", material["extensions"])
        self.assertNotIn("alphaMode", material)
        for mesh in document["meshes"]:
            # By COLOR_0 viewers would multiply the texture.
            self.assertEqual(set(mesh["primitives"][0]["attributes"]), {"POSITION", "_COLOR", "TEXCOORD_0"})
        size = self.report("imgmesh-info", "t.glb")["bytes"]["texture"]
        self.assertEqual(size, len(texture_file(self.folder / "t.glb")))

    def test_the_reconstruction_where_there_is_no_picture(self):
        self.run_ok("imgmesh-convert", "plain.glb", "-o", "t.glb", "--texture", "-q")
        self.assertTrue((texture_of(self.folder / "t.glb") == np.round(self.drawn("plain.glb", 0) * 255)).all())

    def test_round_trips_keep_picture_coordinates_and_map(self):
        self.run_ok("imgmesh-convert", "plain.glb", "-o", "t.glb", "--texture", "--image", "in.png", "-q")
        picture = texture_file(self.folder / "t.glb")
        source = "t.glb"
        for i, (extension, draco) in enumerate([("gltf", "sequential"), ("gltf", "edgebreaker"), ("glb", "none")]):
            output = f"r{i}.{extension}"
            report = self.report("imgmesh-convert", source, "-o", output, "--draco", draco)
            self.assertTrue(report["texture"])
            self.assertEqual(texture_file(self.folder / output), picture)
            self.assert_valid(output)
            self.assert_same_maps(output, "plain.glb")
            source = output
        self.assert_coordinates(source)
        self.assertFalse(self.report("imgmesh-convert", source, "-o", "n.glb", "--no-texture")["texture"])
        self.assertIsNone(texture_file(self.folder / "n.glb"))
        (primitive,) = asset(self.folder / "n.glb")[0]["meshes"][0]["primitives"]
        self.assertEqual(set(primitive["attributes"]), {"POSITION", "COLOR_0"})
        self.assert_same_maps("n.glb", "plain.glb")

    def attribute(self, name, attribute, level=0):
        document, buffer = asset(self.folder / name)
        accessor = document["accessors"][document["meshes"][level]["primitives"][0]["attributes"][attribute]]
        view = document["bufferViews"][accessor["bufferView"]]
        width = {"VEC2": 2, "VEC3": 3}[accessor["type"]]
        return np.frombuffer(buffer, "<f4", accessor["count"] * width, view.get("byteOffset", 0)).reshape(-1, width)

    def assert_coordinates(self, name):
        """Each vertex's are ((x + 0.5) / W, (y + 0.5) / H)."""
        for level in (0, 1):
            position = self.attribute(name, "POSITION", level)
            place = (position[:, :2] * [1, -1] + 0.5) / [48, 32]
            self.assertLess(np.abs(self.attribute(name, "TEXCOORD_0", level) - place).max(), 1e-7)

    def test_levels_without_layers(self):
        self.run_ok("imgmesh-convert", "plain.glb", "-o", "t.glb", "--texture", "-q")
        self.run_ok("imgmesh-convert", "t.glb", "-o", "one.glb", "--levels", "1", "-q")
        self.assert_valid("one.glb")
        self.assertTrue((self.drawn("one.glb", 0) == self.drawn("plain.glb", 1)).all())
        self.run_ok("imgmesh-convert", "t.glb", "-o", "bare.glb", "--no-layers", "-q")
        self.assertEqual(texture_file(self.folder / "bare.glb"), texture_file(self.folder / "t.glb"))

    def test_a_warped_mesh_keeps_its_places_in_the_texture(self):
        self.run_ok("imgmesh-convert", "plain.glb", "-o", "t.glb", "--texture", "--draco", "none", "-q")
        self.run_ok("imgmesh-warp", "t.glb", "--handle", "36,20:1,0", "-o", "w.glb", "-q")
        self.assert_valid("w.glb")
        self.assertEqual(texture_file(self.folder / "w.glb"), texture_file(self.folder / "t.glb"))
        self.assertTrue((self.attribute("w.glb", "TEXCOORD_0") == self.attribute("t.glb", "TEXCOORD_0")).all())
        self.assertFalse((self.attribute("w.glb", "POSITION") == self.attribute("t.glb", "POSITION")).all())

    def test_masked_images(self):
        """The texture is clear outside of the mask; its colours there are near those inside."""
        y, x = np.mgrid[0:32, 0:48]
        inside = (x - 20) ** 2 + (y - 15) ** 2 < 100
        samples = inside[..., None] * np.array([0.2, 0.6, 0.8, 1])
        picture_files.png(self.folder / "cut.png", samples)
        self.build("cut.png", "--density", "3", "--texture", output="cut.glb")
        self.assert_valid("cut.glb")
        texture = texture_of(self.folder / "cut.glb")
        self.assertTrue((texture[..., 3] == np.where(inside, 255, 0)).all())
        self.assertTrue((texture[..., :3] == [51, 153, 204]).all())
        self.assertEqual(asset(self.folder / "cut.glb")[0]["materials"][0]["alphaMode"], "MASK")
        self.run_ok("imgmesh-convert", "cut.glb", "-o", "drawn.glb", "--texture", "-q")
        self.assertTrue((texture_of(self.folder / "drawn.glb")[..., 3] == texture[..., 3]).all())
        jpeg = ["-o", "x.glb", "--texture", "--texture-type", "jpeg"]
        self.assert_error("imgmesh-convert", ["cut.glb", *jpeg], 5, "cut.glb", "PNG")
        self.assert_error("imgmesh-build", ["cut.png", *jpeg], 5, "cut.png", "PNG")

    def test_any_picture_becomes_8_bit_srgb(self):
        ramp = picture_files.ramp(9, 7)
        picture_files.png(self.folder / "deep.png", ramp, bits=16)
        picture_files.png(self.folder / "grey.png", ramp[..., :1])
        picture_files.write_float(self.folder / "light.exr", 4 * ramp)
        palette = np.arange(63).reshape(7, 9) % 4
        picture_files.png(self.folder / "palette.png", palette, palette=[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]])
        for width, height in ((1, 1), (1, 7)):
            picture_files.png(self.folder / f"odd{width}{height}.png", picture_files.noise(width, height))
        for name in ("deep.png", "grey.png", "light.exr", "palette.png", "odd11.png", "odd17.png"):
            self.build(name, "--density", "100", "--texture", output="x.gltf")
            self.assert_valid("x.gltf")
            texture = texture_of(self.folder / "x.gltf")
            self.assertEqual((texture.dtype, texture.shape[2]), (np.uint8, 3))
            self.run_ok("imgmesh-convert", "x.gltf", "-o", "y.glb", "--texture", "-q")
        picture_files.write_float(self.folder / "depth.exr", ramp[..., :1], names=["Z"])
        self.assert_error("imgmesh-build", ["depth.exr", "-o", "z.glb", "--channels", "Z", "--texture"], 5, "depth.exr")
        self.run_ok("imgmesh-build", "depth.exr", "-o", "depth.glb", "--channels", "Z", "-q")
        self.assert_error("imgmesh-convert", ["depth.glb", "-o", "z.glb", "--texture"], 5, "--image")
        self.run_ok("imgmesh-convert", "depth.glb", "-o", "z.glb", "--texture", "--image", "deep.png", "-q")
        self.assert_valid("z.glb")

    def test_jpeg(self):
        self.run_ok("imgmesh-convert", "plain.glb", "-o", "t.glb", "--texture", "--texture-type", "jpeg", "-q")
        self.assert_valid("t.glb")
        self.assertEqual(texture_file(self.folder / "t.glb")[:3], b"\xff\xd8\xff")
        self.assertEqual(asset(self.folder / "t.glb")[0]["images"][0]["mimeType"], "image/jpeg")

    def test_wrong_use(self):
        picture_files.png(self.folder / "small.png", picture_files.ramp(4, 4))
        wrong = [(["-o", "x.svg", "--texture"], 2, "--texture"), (["-o", "x.glb", "--image", "in.png"], 2, "--texture"),
                 (["-o", "x.glb", "--no-texture", "--image", "in.png"], 2, "--image"),
                 (["-o", "x.glb", "--texture", "--no-texture"], 2, "--no-texture"),
                 (["-o", "x.glb", "--texture-type", "png"], 2, "--texture"),
                 (["-o", "x.glb", "--texture", "--texture-type", "gif"], 2, "jpeg"),
                 (["-o", "x.glb", "--texture", "--image", "none.png"], 3, "none.png"),
                 (["-o", "x.glb", "--texture", "--image", "plain.glb"], 5, "plain.glb"),
                 (["-o", "x.glb", "--texture", "--image", "small.png"], 4, "small.png", "48x32")]
        for args, code, *words in wrong:
            self.assert_error("imgmesh-convert", ["plain.glb", *args], code, *words)


if __name__ == "__main__":
    main()
