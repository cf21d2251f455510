"""imgmesh-info: facts, verdicts, and what it must not load."""
import json
import struct

import picture_files
from support import CliCase, main


class Info(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "in.png", picture_files.ramp(48, 32))
        self.built = self.build("in.png", "--faces", "200", output="c.glb")
        self.build("in.png", "--faces", "200", output="g.gltf")

    def verdict(self, name, code=4):
        """The finding of a broken container, which every tool refuses alike."""
        report = self.report("imgmesh-info", name, "--validate", code=code)
        self.assertFalse(report["valid"])
        finding = next(f for f in report["findings"] if f["severity"] == "error")
        result = self.run_tool("imgmesh-info", name, "--validate")
        self.assert_error_lines("imgmesh-info", result, code, 1)
        for word in (finding["code"], finding["message"]):
            self.assertIn(word, result.stderr)
            self.assertIn(word, result.stdout)
        self.assertEqual(self.assert_error("imgmesh-info", [name], code).stderr, result.stderr)
        self.assert_error("imgmesh-reconstruct", [name, "-o", "out.png"], code, finding["code"])
        return finding

    def test_facts(self):
        facts = self.report("imgmesh-info", "c.glb")
        self.assertEqual((facts["width"], facts["height"]), (48, 32))
        self.assertEqual((facts["channels"], facts["color_space"], facts["sample_type"]), (["R", "G", "B"], "sRGB", "uint8"))
        self.assertEqual(facts["built_by"], facts["generator"].replace("-info", "-build"))
        self.assertEqual(sum(facts["bytes"][part] for part in ("meshes", "layers", "other")), facts["bytes"]["total"])
        self.assertEqual(facts["build"]["faces"], 200)
        (level,) = facts["levels"]
        mesh, pixel_map = level["mesh"], level["map"]
        self.assertEqual((level["vertices"], level["faces"]), (self.built["vertices"], self.built["faces"]))
        self.assertEqual(level["vertices"] - mesh["edges"] + level["faces"], mesh["euler"])
        self.assertEqual((mesh["euler"], mesh["components"]), (1, 1))
        for count in ("nonmanifold_edges", "nonmanifold_vertices", "flipped_faces"):
            self.assertEqual(mesh[count], 0)
        self.assertAlmostEqual(mesh["area"], 47 * 31)
        self.assertEqual(pixel_map["pixels"], 48 * 32)
        for count in ("unmapped", "outside_simplex", "flipped_triangles"):
            self.assertEqual(pixel_map[count], 0)

    def test_a_build_reports_what_a_reader_gets(self):
        """A build does not read its container again, but its figures must be those of the file."""
        soft = [[(*color, float(x > 9)) for x, color in enumerate(row)] for row in picture_files.ramp(40, 30)]
        picture_files.png(self.folder / "soft.png", soft)
        cases = {"plain.glb": ["in.png", "--draco", "none"], "edges.gltf": ["in.png", "--levels", "2"],
                 "small.glb": ["in.png", "--preset", "small"], "cut.glb": ["soft.png", "--alpha", "cut"],
                 "kept.glb": ["soft.png", "--alpha", "keep"], "values.glb": ["in.png", "--values"],
                 "tracked.glb": ["in.png", "--map", "tracked"], "drawn.glb": ["in.png", "--texture"]}
        for output, (picture, *options) in cases.items():
            with self.subTest(output):
                built = self.build(picture, *options, "--faces", "100", output=output)
                facts = self.report("imgmesh-info", output)
                parts = {"bytes": "total", "mesh_bytes": "meshes", "layer_bytes": "layers", "texture_bytes": "texture"}
                self.assertEqual([built[part] for part in parts], [facts["bytes"][part] for part in parts.values()])
                self.assertEqual({name: built["parameters"][name] for name in facts["build"]}, facts["build"])
                self.assertEqual(built["has_light"], facts["has_light"])
                for written, read in zip(built["levels"], facts["levels"], strict=True):
                    for figure in ("vertices", "faces", "error"):
                        self.assertEqual(written[figure], read[figure])
                    self.assertAlmostEqual(written["mean_edge_ratio"], read["mesh"]["mean_edge_ratio"], 9)
                    self.assertEqual(written["flipped_pixel_triangles"], read["map"]["flipped_triangles"])

    def test_both_file_variants_say_the_same(self):
        facts = [self.report("imgmesh-info", name) for name in ("c.glb", "g.gltf")]
        for member in ("levels", "build", "channels", "version"):
            self.assertEqual(facts[0][member], facts[1][member])

    def test_text(self):
        text = self.run_ok("imgmesh-info", "c.glb").stdout
        for words in ("48 x 32", "edgebreaker", "sRGB", "level 0", f"{self.built['faces']} faces"):
            self.assertIn(words, text)

    def test_valid(self):
        for name in ("c.glb", "g.gltf"):
            self.assertEqual(self.run_ok("imgmesh-info", name, "--validate").stdout, f"{name}: valid\n")
            self.assertEqual(self.report("imgmesh-info", name, "--validate")["findings"], [])

    def test_every_finding_and_its_place(self):
        """Several defects at once, in the JSON and in the EXR of one container."""
        def break_it(d):
            d["extensions"]["IMGMESH_pixel_map"]["version"] = "2.0"
            d["nodes"][0]["name"] = "x"
            d["nodes"][0]["extensions"]["IMGMESH_pixel_map"]["topology"] = "0" * 64
        report = self.report("imgmesh-info", self.edited(break_it), "--validate", code=5)
        found = {f["code"]: f for f in report["findings"]}
        self.assertEqual(set(found), {"ext.version", "gltf.names", "mesh.topology", "layers.topology"})
        self.assertEqual((report["errors"], report["warnings"], report["infos"]), (3, 1, 0))
        self.assertEqual(found["ext.version"]["place"], {"pointer": "/extensions/IMGMESH_pixel_map/version"})
        self.assertEqual(found["mesh.topology"]["place"], {"pointer": "/meshes/0"})
        self.assertEqual(found["layers.topology"]["place"], {"part": "lod0"})

    def test_warnings(self):
        name = self.edited(lambda d: d["nodes"][0].update(name="x"))
        self.assertIn("warning gltf.names", self.run_ok("imgmesh-info", name, "--validate").stdout)
        result = self.run_tool("imgmesh-info", name, "--validate", "--warnings-as-errors")
        self.assert_error_lines("imgmesh-info", result, 4, 1)
        self.assertIn("not valid", result.stdout)
        self.assert_error("imgmesh-info", [name, "--warnings-as-errors"], 2, "--validate")

    def test_limits(self):
        size = (self.folder / "c.glb").stat().st_size
        self.run_ok("imgmesh-info", "c.glb", "--max-bytes", size)
        for option, value in (("--max-bytes", size - 1), ("--max-pixels", 48 * 32 - 1), ("--max-faces", 10),
                              ("--max-json-depth", 2)):
            self.assert_error("imgmesh-info", ["c.glb", option, value], 4, "[")
            for wrong in ("0", "-1", "x", "1e3"):
                self.assert_error("imgmesh-info", ["c.glb", option, wrong], 2, option, wrong)
        self.assert_error("imgmesh-info", ["c.glb", "--max-levels", "0"], 2, "--max-levels")

    def test_truncated_anywhere(self):
        data = (self.folder / "c.glb").read_bytes()
        for length in (0, 1, 11, 12, 19, 20, 100, len(data) // 2, len(data) - 1):
            (self.folder / "cut.glb").write_bytes(data[:length])
            with self.subTest(length):
                self.verdict("cut.glb")

    def test_no_container(self):
        (self.folder / "plain.gltf").write_text('{"asset": {"version": "2.0"}}')
        self.assertEqual(self.verdict("plain.gltf")["code"], "ext.missing")
        (self.folder / "deep.gltf").write_text("[" * 100000)
        self.assertEqual(self.verdict("deep.gltf")["code"], "json.depth")
        (self.folder / "words.gltf").write_text("words")
        verdict = self.verdict("words.gltf")
        self.assertEqual(verdict["code"], "json.syntax")
        self.assertTrue(verdict["message"].startswith("parse error at line 1, column 1"), verdict)

    def test_sidecar_files(self):
        exr, binary = (self.folder / "g.exr").read_bytes(), (self.folder / "g.bin").read_bytes()
        (self.folder / "g.exr").unlink()
        self.assert_error("imgmesh-info", ["g.gltf", "--validate"], 3, "g.exr")
        (self.folder / "g.exr").write_bytes(exr[:len(exr) // 2])
        self.assertTrue(self.verdict("g.gltf")["code"].startswith("layers."))
        (self.folder / "g.exr").write_bytes(exr)
        (self.folder / "g.bin").write_bytes(binary[:-8])
        self.verdict("g.gltf")
        (self.folder / "g.bin").unlink()
        self.assert_error("imgmesh-info", ["g.gltf"], 3, "g.bin")

    def edited(self, edit):
        """A copy of g.gltf whose JSON went through `edit`."""
        document = json.loads((self.folder / "g.gltf").read_text())
        edit(document)
        (self.folder / "e.gltf").write_text(json.dumps(document))
        return "e.gltf"

    def test_edited_json(self):
        def root(document):
            return document["extensions"]["IMGMESH_pixel_map"]
        self.assertEqual(self.verdict(self.edited(lambda d: root(d)["layers"].update(uri="../g.exr")))["code"],
                         "uri.name")
        self.assertEqual(self.verdict(self.edited(lambda d: root(d).update(version="9.0")), code=5)["code"],
                         "ext.version")
        self.verdict(self.edited(lambda d: root(d)["image"].update(width=49)))
        self.verdict(self.edited(lambda d: root(d)["image"].update(width=2**31 - 1, height=2**31 - 1)))
        self.verdict(self.edited(lambda d: root(d)["image"].update(width=-48)))
        self.verdict(self.edited(lambda d: d["bufferViews"][0].update(byteLength=2**40)))
        node = lambda d: next(n for n in d["nodes"] if "IMGMESH_pixel_map" in n.get("extensions", {}))
        wrong = {"topology": "0" * 64}
        self.assertEqual(self.verdict(self.edited(
            lambda d: node(d)["extensions"]["IMGMESH_pixel_map"].update(wrong)))["code"], "mesh.topology")
        self.verdict(self.edited(lambda d: d.update(nodes=[])))

    def test_flipped_bytes_never_crash(self):
        """Each changed byte is found, or the container is still sound: never a signal, never code 1."""
        data = (self.folder / "c.glb").read_bytes()
        for at in range(0, len(data), max(1, len(data) // 60)):
            changed = bytearray(data)
            changed[at] ^= 0xFF
            (self.folder / "x.glb").write_bytes(changed)
            result = self.run_tool("imgmesh-info", "x.glb", "--validate")
            with self.subTest(at):
                self.assertIn(result.returncode, (0, 4, 5), result.stderr)
                if result.returncode == 4:
                    self.assert_error_lines("imgmesh-info", result, 4, 1)

    def test_length_of_the_header_is_checked_before_memory(self):
        data = bytearray((self.folder / "c.glb").read_bytes())
        struct.pack_into("<I", data, 12, 0xFFFFFFF0)
        (self.folder / "x.glb").write_bytes(data)
        self.verdict("x.glb")


if __name__ == "__main__":
    main()
