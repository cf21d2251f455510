"""EXR images: parts, layers, samples that are not finite, and what the header says, through the tools."""
import json

import numpy as np
import OpenImageIO as oiio

import picture_files as files
from support import CliCase, main

LAYERS = ["a.R", "a.G", "a.B", "b.R", "b.G", "b.B", "b.Z"]


class Exr(CliCase):
    def layers(self, name="l.exr", far=np.inf, **attributes):
        """Colour in the layer a, half of it in b, and a depth of which one sample is `far`."""
        colour = files.ramp(24, 18)
        depth = np.full((18, 24, 1), 3.0)
        depth[5, 7] = far
        samples = np.dstack([colour, colour / 2, depth]).astype(np.float32)
        spec = oiio.ImageSpec(24, 18, len(LAYERS), "half")
        spec.channelnames = LAYERS
        for key, value in attributes.items():
            if key.startswith("full_"):
                setattr(spec, key, value)
            else:
                spec.attribute(key, value)
        out = oiio.ImageOutput.create("x.exr")
        if not out.open(str(self.folder / name), spec) or not out.write_image(samples) or not out.close():
            raise RuntimeError(out.geterror())
        return self.folder / name

    def test_layers(self):
        path = self.layers(far=9)
        self.assertEqual(self.build(path)["layer"], "a")
        self.assertEqual(self.build(path, "--layer", "b", "--part", "0", "--faces", 100000, output="b.glb")["layer"], "b")
        for tool, args in (("imgmesh-segment", ("b.glb", "-o", "s.png")),
                           ("imgmesh-warp", ("b.glb", "-o", "w.exr", "--handle", "3,3:0,0")),
                           ("imgmesh-convert", ("b.glb", "-o", "c.glb", "--texture"))):
            self.run_ok(tool, *args, "--image", path, "--layer", "b", "--overwrite")
            self.assert_error(tool, [*args, "--image", path, "--layer", "x", "--overwrite"], 4, "l.exr", "no layer x",
                              "its layers are a, b")
            self.assert_error(tool, [*args, "--layer", "b", "--overwrite"], 2, "--layer", "--image")
        found = self.report("imgmesh-compare", path, "b.glb", "--layer", "b")
        self.assertEqual(found["inputs"][0]["layer"], "b")
        self.assertLess(found["difference"]["rms_luv"], 2)
        self.assert_error("imgmesh-compare", ["b.glb", "--layer", "b"], 2, "--layer", "two files")
        self.assertIn("neither parts nor layers", " ".join(self.report(
            "imgmesh-build", files.png(self.folder / "p.png", files.ramp(9, 9)), "-o", "p.glb", "--layer", "b")["warnings"]))

    def test_non_finite(self):
        path = self.layers()
        args = ("--layer", "b", "--channels", "R,G,B,Z")
        self.assert_error("imgmesh-build", [path, "-o", "x.glb", *args], 4, "channel Z of pixel (7, 5)")
        for how in ("zero", "nearest"):
            self.assertEqual(self.build(path, *args, "--non-finite", how, output=f"{how}.glb")["non_finite"], 1)
        self.assertNotIn("non_finite", self.build(path, "--non-finite", "zero", output="c.glb"))

    def test_header(self):
        path = self.layers(Copyright="Ann", shot="010", full_x=0, full_y=0, full_width=30, full_height=20)
        self.build(path, output="h.gltf")
        metadata = json.loads((self.folder / "h.gltf").read_text())["extensions"]["IMGMESH_pixel_map"]["image"]["metadata"]
        self.assertEqual(metadata["shot"], {"type": "string", "value": "010"})
        self.run_ok("imgmesh-convert", "h.gltf", "-o", "h.glb")
        self.run_ok("imgmesh-reconstruct", "h.glb", "-o", "again.exr")
        spec = files.spec(self.folder / "again.exr")
        self.assertEqual((spec.width, spec.height, spec.full_width, spec.full_height), (24, 18, 30, 20))
        self.assertEqual((spec.getattribute("Copyright"), spec.getattribute("shot")), ("Ann", "010"))
        # Another format has no place for it, and a plain EXR needs none.
        self.run_ok("imgmesh-reconstruct", "h.glb", "-o", "again.png")
        self.run_ok("imgmesh-info", "h.glb", "--validate")


if __name__ == "__main__":
    main()
