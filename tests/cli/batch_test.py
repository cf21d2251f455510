"""Many images in one process, and the same bytes whatever the threads."""
import picture_files
from support import CliCase, main


class Batch(CliCase):
    def setUp(self):
        super().setUp()
        for i, (width, height) in enumerate(((40, 30), (7, 50), (33, 33))):
            picture_files.png(self.folder / f"p{i}.png", picture_files.noise(width, height, seed=i))

    def run_batch(self, *args):
        result = self.run_tool("imgmesh-build", "p0.png", "p1.png", "p2.png", *args)
        return result

    def outputs(self, folder):
        return {name[len(folder):]: data for name, data in self.files().items() if name.startswith(folder)}

    def test_same_bytes_for_any_threads_and_twice(self):
        runs = []
        for folder, threads in (("a/", "1"), ("b/", "2"), ("c/", "2"), ("d/", "5")):
            self.assertEqual(self.run_batch("-o", folder, "--threads", threads).returncode, 0)
            runs.append(self.outputs(folder))
        self.assertEqual(sorted(runs[0]), ["p0.glb", "p1.glb", "p2.glb"])
        for run in runs[1:]:
            self.assertEqual(run, runs[0])

    def test_alone_or_in_company(self):
        """An image's container does not depend on what else the process builds."""
        self.assertEqual(self.run_batch("-o", "all/").returncode, 0)
        for i in range(3):
            self.build(f"p{i}.png", output=f"one{i}.glb")
            self.assertEqual((self.folder / f"one{i}.glb").read_bytes(),
                             (self.folder / f"all/p{i}.glb").read_bytes())

    def test_same_bytes_of_the_other_file_variant_and_drawings(self):
        self.build("p0.png", "--threads", "1", output="a.gltf")
        first = self.outputs("a.")
        for threads in ("1", "2"):
            self.build("p0.png", "--threads", threads, output="a.gltf")
            self.assertEqual(self.outputs("a."), first)
        for mode in ("map", "gouraud", "wire", "patches", "flat"):
            drawn = set()
            for threads in ("1", "2"):
                self.run_ok("imgmesh-reconstruct", "a.gltf", "-o", "x.png", "--mode", mode, "--threads", threads)
                drawn.add((self.folder / "x.png").read_bytes())
            self.assertEqual(len(drawn), 1, mode)

    def test_existing_folder_needs_no_slash(self):
        (self.folder / "there").mkdir()
        self.assertEqual(self.run_batch("-o", "there").returncode, 0)
        self.assertEqual(sorted(self.outputs("there/")), ["p0.glb", "p1.glb", "p2.glb"])
        self.report("imgmesh-build", "p0.png", "-o", "deep/er/")
        self.assertEqual(sorted(self.outputs("deep/")), ["er/p0.glb"])

    def test_one_bad_picture(self):
        (self.folder / "bad.png").write_bytes(b"no picture at all")
        result = self.run_tool("imgmesh-build", "p0.png", "bad.png", "p1.png", "-o", "out/")
        self.assert_error_lines("imgmesh-build", result, 4, 1)
        self.assertIn("bad.png", result.stderr)
        self.assertEqual(sorted(self.outputs("out/")), ["p0.glb", "p1.glb"])
        report = self.report("imgmesh-build", "p0.png", "bad.png", "p1.png", "-o", "out/", code=4)
        self.assertEqual([("failure" in image, image["input"]) for image in report["images"]],
                         [(False, "p0.png"), (True, "bad.png"), (False, "p1.png")])
        self.assertEqual(report["images"][1]["failure"]["code"], 4)
        self.assertEqual("imgmesh-build: error: " + report["images"][1]["failure"]["message"] + "\n", result.stderr)

    def test_exit_code_of_several_failures(self):
        """That of all where they agree, else 4."""
        (self.folder / "bad.png").write_bytes(b"no picture at all")
        missing = self.run_tool("imgmesh-build", "p0.png", "m1.png", "m2.png", "-o", "out/")
        self.assert_error_lines("imgmesh-build", missing, 3, 2)
        self.assertLess(missing.stderr.index("m1.png"), missing.stderr.index("m2.png"))
        mixed = self.run_tool("imgmesh-build", "m1.png", "bad.png", "p0.png", "-o", "out/")
        self.assert_error_lines("imgmesh-build", mixed, 4, 2)

    def test_no_overwrite_keeps_what_is_there(self):
        (self.folder / "out").mkdir()
        (self.folder / "out/p1.glb").write_bytes(b"mine")
        result = self.run_batch("-o", "out/", "--no-overwrite")
        self.assert_error_lines("imgmesh-build", result, 3, 1)
        self.assertEqual((self.folder / "out/p1.glb").read_bytes(), b"mine")
        self.assertEqual(sorted(self.outputs("out/")), ["p0.glb", "p1.glb", "p2.glb"])

    def test_text_report_names_each(self):
        text = self.run_batch("-o", "out/").stdout
        for i in range(3):
            self.assertIn(f"p{i}.png -> out/p{i}.glb\n", text)
        self.assertIn("40 x 30", text)


if __name__ == "__main__":
    main()
