"""Files that cannot be read or written: the right exit code, one line, and nothing left behind."""
import resource

import picture_files
from support import CliCase, main


class Unreadable(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "good.png", picture_files.ramp(40, 30))

    def test_missing(self):
        self.assert_error("imgmesh-build", ["none.png", "-o", "out.glb"], 3, "none.png")
        self.assert_error("imgmesh-build", ["", "-o", "out.glb"], 3)
        self.assert_error("imgmesh-build", ["good.png/x.png", "-o", "out.glb"], 3, "good.png/x.png")
        self.assert_error("imgmesh-info", ["none.glb"], 3, "none.glb")
        self.assert_error("imgmesh-reconstruct", ["none.gltf", "-o", "out.png"], 3, "none.gltf")

    def test_folder(self):
        for name in ("f.png", "f.glb"):
            (self.folder / name).mkdir()
        self.assert_error("imgmesh-build", ["f.png", "-o", "out.glb"], 3, "f.png")
        self.assert_error("imgmesh-info", ["f.glb"], 3, "f.glb")

    def test_name_too_long(self):
        name = "n" * 300
        self.assert_error("imgmesh-build", [name + ".png", "-o", "out.glb"], 3, name)
        self.assert_error("imgmesh-build", ["good.png", "-o", name + ".glb"], 3, name)
        self.assert_error("imgmesh-build", ["good.png", "-o", name + "/"], 3, name)

    def test_empty(self):
        for name in ("e.png", "e.exr", "e.tif", "e.jpg", "e"):
            (self.folder / name).write_bytes(b"")
            self.assert_error("imgmesh-build", [name, "-o", "out.glb"], 4, name)

    def test_no_picture(self):
        for name in ("t.png", "t.exr", "t.jpg", "t.txt", "t.bmp", "t.tif"):
            (self.folder / name).write_bytes(b"These are words, and words are no picture.\n" * 20)
            self.assert_error("imgmesh-build", [name, "-o", "out.glb"], 4, name)

    def test_truncated(self):
        picture_files.write_float(self.folder / "good.exr", picture_files.noise(64, 48))
        picture_files.write_float(self.folder / "good.tif", picture_files.noise(64, 48), "uint8")
        picture_files.png(self.folder / "noise.png", picture_files.noise(64, 48))
        for source in ("noise.png", "good.exr", "good.tif"):
            data = (self.folder / source).read_bytes()
            for length in (10, 40, len(data) // 2, len(data) - 100):
                name = f"cut-{length}-{source}"
                (self.folder / name).write_bytes(data[:length])
                self.assert_error("imgmesh-build", [name, "-o", "out.glb"], 4, name)

    def test_absurdly_large(self):
        """Refused from the header, before memory is taken; a limit on memory makes sure of it."""
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
        picture_files.huge_png(self.folder / "huge.png")
        picture_files.huge_png(self.folder / "wide.png", width=2**31 - 1, height=1)
        for name in ("huge.png", "wide.png"):
            result = self.run_tool("imgmesh-build", name, "-o", "out.glb", preexec_fn=limit)
            self.assert_error_lines("imgmesh-build", result, 4, 1)
            self.assertIn(name, result.stderr)

    def test_limits_as_options(self):
        self.run_ok("imgmesh-build", "good.png", "-o", "c.glb", "-q", "--max-pixels", "1200")
        self.assert_error("imgmesh-build", ["good.png", "-o", "d.glb", "--max-pixels", "1199"], 4, "good.png")
        self.assert_error("imgmesh-build", ["good.png", "-o", "d.glb", "--max-pixels", "0"], 2, "--max-pixels")
        self.run_ok("imgmesh-reconstruct", "c.glb", "-o", "x.png", "-q", "--max-pixels", "1200")
        self.assert_error("imgmesh-reconstruct", ["c.glb", "-o", "y.png", "--max-pixels", "1199"], 4, "limits.pixels")

    def test_values_that_are_not_finite(self):
        samples = picture_files.noise(8, 8)
        for value in (float("nan"), float("inf")):
            samples[3, 4, 1] = value
            picture_files.write_float(self.folder / "in.exr", samples)
            self.assert_error("imgmesh-build", ["in.exr", "-o", "out.glb"], 4, "in.exr")

    def test_containers_are_no_pictures_and_the_other_way_round(self):
        self.run_ok("imgmesh-build", "good.png", "-o", "c.glb", "-q")
        self.assert_error("imgmesh-build", ["c.glb", "-o", "out.glb"], 5, "c.glb", "imgmesh-reconstruct")
        self.assert_error("imgmesh-info", ["good.png"], 4, "good.png")


class Unwritable(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "in.png", picture_files.ramp(40, 30))
        self.run_ok("imgmesh-build", "in.png", "-o", "c.glb", "-q")
        self.runs = [("imgmesh-build", "in.png", ("x.glb", "x.gltf")),
                     ("imgmesh-reconstruct", "c.glb", ("x.png", "x.exr", "x.tif", "x.jpg"))]
        self.svg = ("imgmesh-reconstruct", "c.glb", "--mode", "wire")

    def test_folder_that_is_not_there(self):
        for tool, source, names in self.runs:
            for name in names:
                self.assert_error(tool, [source, "-o", f"none/{name}"], 3, f"none/{name}")
                self.assert_error(tool, [source, "-o", f"in.png/{name}"], 3, f"in.png/{name}")
        self.assert_error(self.svg[0], [*self.svg[1:], "-o", "none/x.svg"], 3, "none/x.svg")
        self.assert_error("imgmesh-build", ["in.png", "-o", "in.png/"], 3, "in.png/")
        self.assert_error("imgmesh-build", ["in.png", "-o", "in.png/deeper/"], 3, "in.png/deeper/")

    def test_a_folder_stands_there(self):
        for _, _, names in self.runs:
            for name in names:
                (self.folder / name).mkdir()
        # A folder named as the output gets the file; one where the file is due stays.
        (self.folder / "x.png/c.png").mkdir()
        self.assert_error("imgmesh-reconstruct", ["c.glb", "-o", "x.png"], 3, "x.png/c.png")

    def test_names_beside_a_gltf_that_others_have(self):
        """What stands there stays: the container's own files get other names."""
        (self.folder / "y.bin").mkdir()
        (self.folder / "y.exr").write_bytes(b"mine")
        for options in ([], ["--no-overwrite"]):
            self.run_ok("imgmesh-build", "in.png", "-o", "y.gltf", "-q", *options)
            self.assertEqual((self.folder / "y.exr").read_bytes(), b"mine")
            self.assertEqual(self.report("imgmesh-info", "y.gltf", "--validate")["findings"], [])
            self.assertEqual(sorted(f.split("-")[0] for f in self.files() if f.startswith("y-")), ["y", "y"])
            (self.folder / "y.gltf").unlink()

    def test_no_overwrite(self):
        for tool, source, names in self.runs:
            for name in names:
                (self.folder / name).write_bytes(b"mine")
                self.assert_error(tool, [source, "-o", name, "--no-overwrite"], 3, name)
        (self.folder / "x.svg").write_bytes(b"mine")
        self.assert_error(self.svg[0], [*self.svg[1:], "-o", "x.svg", "--no-overwrite"], 3, "x.svg")
        (self.folder / "dangling.glb").symlink_to("nowhere")
        self.assert_error("imgmesh-build", ["in.png", "-o", "dangling.glb", "--no-overwrite"], 3, "dangling.glb")

    def test_overwrite_is_the_default(self):
        (self.folder / "x.glb").write_bytes(b"old")
        self.build("in.png", output="x.glb")
        self.assertEqual((self.folder / "x.glb").read_bytes(), (self.folder / "c.glb").read_bytes())

    def test_input_is_never_replaced(self):
        """x.gltf comes with x.bin and x.exr, and any name may lead to the input."""
        picture_files.write_float(self.folder / "x.exr", picture_files.ramp(12, 8))
        self.assert_error("imgmesh-build", ["x.exr", "-o", "x.gltf"], 2, "x.exr", "input")
        (self.folder / "link.glb").symlink_to("in.png")
        self.assert_error("imgmesh-build", ["in.png", "-o", "./link.glb"], 2, "in.png", "input")
        self.run_ok("imgmesh-build", "in.png", "-o", "g.gltf", "-q")
        self.assert_error("imgmesh-reconstruct", ["g.gltf", "-o", "g.exr"], 2, "g.exr", "input")

    def test_full_disk(self):
        """A limit on file size fails writes half-way, as a full disk does."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        (self.folder / "x.glb").write_bytes(b"old")
        picture_files.png(self.folder / "in.png", picture_files.noise(64, 48))
        self.run_ok("imgmesh-build", "in.png", "-o", "c.glb", "--density", "20", "-q")
        before = self.files()
        for tool, source, names in self.runs:
            for name in names:
                result = self.run_tool(tool, source, "-o", name, preexec_fn=limit)
                with self.subTest(tool=tool, name=name):
                    self.assert_error_lines(tool, result, 3, 1)
                    self.assertIn(name.split(".")[0] + ".", result.stderr)
                    self.assertEqual(self.files(), before)
        result = self.run_tool(*self.svg, "-o", "x.svg", preexec_fn=limit)
        self.assert_error_lines("imgmesh-reconstruct", result, 3, 1)
        self.assertEqual(self.files(), before)


    def test_files_of_another_gltf_are_kept(self):
        """An x.gltf that does not refer to x.exr gives no right to replace it."""
        picture_files.png(self.folder / "p.png", picture_files.noise(20, 15, seed=1))
        (self.folder / "x.exr").write_bytes(b"a picture of somebody's")
        (self.folder / "x.gltf").write_text(
            '{"asset":{"version":"2.0"},"buffers":[{"uri":"geometry.bin","byteLength":1}]}')
        (self.folder / "geometry.bin").write_bytes(b"g")
        self.run_ok("imgmesh-build", "p.png", "-o", "x.gltf", "-q")
        self.assertEqual((self.folder / "x.exr").read_bytes(), b"a picture of somebody's")
        self.assertEqual((self.folder / "geometry.bin").read_bytes(), b"g")
        self.assertEqual(self.report("imgmesh-info", "x.gltf", "--validate")["findings"], [])

    def test_layers_of_another_mesh_are_refused(self):
        for name, seed in (("a", 1), ("b", 2)):
            picture_files.png(self.folder / "p.png", picture_files.noise(40, 30, seed=seed))
            self.build("p.png", "--vertices", "60", output=f"{name}.gltf")
        (self.folder / "a.exr").write_bytes((self.folder / "b.exr").read_bytes())
        self.assert_error("imgmesh-info", ["a.gltf"], 4, "a.gltf", "layers.")


if __name__ == "__main__":
    main()
