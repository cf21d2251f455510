"""Arrays of images and meshes: what they hold, that they are views, and that they live as long as they are used."""
import gc
import unittest

import numpy as np
from PIL import Image

import imgmesh
import picture_files


def ramp(dtype=np.uint8, width=48, height=32):
    top = np.iinfo(dtype).max
    return np.round(picture_files.ramp(width, height) * top).astype(dtype)


class Arrays(unittest.TestCase):
    def setUp(self):
        self.mesh = imgmesh.build(ramp(), density=8, levels=2, visits=True)

    def test_shapes(self):
        mesh = self.mesh
        self.assertEqual((mesh.width, mesh.height, len(mesh.levels)), (48, 32, 2))
        for level in (mesh, *mesh.levels):
            v, f = len(level.vertices), len(level.faces)
            shapes = {"vertices": ((v, 2), "f4"), "faces": ((f, 3), "u4"), "features": ((v, 3), "f4"),
                      "colors": ((v, 3), "f4"), "face_ids": ((32, 48), "u4"), "barycentrics": ((32, 48, 2), "f4"),
                      "mask": ((32, 48), "?")}
            for name, (shape, dtype) in shapes.items():
                array = getattr(level, name)
                self.assertEqual((array.shape, array.dtype), (shape, np.dtype(dtype)), name)
        self.assertEqual((mesh.visits.shape, mesh.visits.dtype), ((32, 48), np.uint32))
        self.assertGreater(len(mesh.levels[0].faces), len(mesh.levels[1].faces))
        self.assertTrue(mesh.mask.all())

    def test_the_map_reconstructs_the_image(self):
        """Colours at the corners, weighted, are the reconstruction in L*u*v*; so the arrays mean what they say."""
        mesh = self.mesh
        corners = mesh.features[mesh.faces[mesh.face_ids]]
        u, v = mesh.barycentrics[..., :1], mesh.barycentrics[..., 1:]
        luv = (1 - u - v) * corners[..., 0, :] + u * corners[..., 1, :] + v * corners[..., 2, :]
        drawn = np.asarray(mesh.reconstruct())
        self.assertAlmostEqual(luv[5, 5, 0], 100 * lightness(drawn[5, 5] / 255), places=0)
        self.assertLess(imgmesh.compare(drawn, ramp()).rms_luv, 3)
        a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
        area = (b - a)[:, 1] * (c - a)[:, 0] - (b - a)[:, 0] * (c - a)[:, 1]
        self.assertTrue((area > 0).all())

    def test_views_are_read_only_and_share_memory(self):
        mesh = self.mesh
        for name in ("vertices", "faces", "features", "face_ids", "barycentrics", "visits"):
            array = getattr(mesh, name)
            self.assertTrue(np.shares_memory(array, getattr(mesh, name)), name)
            self.assertFalse(array.flags.writeable)
            with self.assertRaises(ValueError):
                array[0] = 0
            with self.assertRaises(ValueError):
                array.setflags(write=True)

    def test_a_view_keeps_its_owner(self):
        for round in range(20):
            mesh = imgmesh.build(ramp(), density=8)
            level, image = mesh.levels[0], mesh.reconstruct()
            labels, difference = mesh.segment().labels, imgmesh.compare(mesh, ramp()).luv
            views = [mesh.vertices, level.faces, mesh.face_ids[::2, ::3], mesh.barycentrics, image.samples,
                     np.asarray(image), labels, difference]
            copies = [view.copy() for view in views]
            del mesh, level, image
            gc.collect()
            imgmesh.build(np.zeros((64, 64), np.uint8))  # takes what was free
            for view, copy in zip(views, copies):
                np.testing.assert_array_equal(view, copy)

    def test_images(self):
        for array in (ramp(), ramp(np.uint16), ramp()[..., 0], np.dstack([ramp(), ramp()[..., :1]]), ramp()[..., :2],
                      picture_files.ramp(9, 7).astype(np.float32), picture_files.ramp(9, 7).astype(np.float16)):
            image = imgmesh.Image(array)
            np.testing.assert_array_equal(np.asarray(image), array)
            self.assertEqual((image.dtype, image.shape), (array.dtype, array.shape))
            self.assertEqual(image.color_space, "sRGB" if array.dtype.kind == "u" else "linear")
            self.assertEqual(image.samples.shape, (*array.shape[:2], len(image.channel_names)))
        self.assertEqual(imgmesh.Image(ramp()[..., :2]).channel_names, ("Y", "A"))
        self.assertEqual(imgmesh.Image(np.zeros((4, 4, 5), "f4"), channel_names=list("abcde")).channel_names, tuple("abcde"))
        np.testing.assert_array_equal(np.asarray(Image.fromarray(imgmesh.Image(ramp()).array)), ramp())

    def test_odd_layouts_are_converted(self):
        plain = ramp(np.uint16)
        expected = imgmesh.build(plain).vertices
        wide = np.zeros((64, 96, 3), np.uint16)
        wide[::2, ::2] = plain
        for array in (wide[::2, ::2], np.asfortranarray(plain), plain.astype(">u2"), plain[::-1][::-1], plain.tolist()):
            if isinstance(array, list):
                array = np.array(array, np.uint16)
            np.testing.assert_array_equal(imgmesh.build(array).vertices, expected)

    def test_values_keep_their_numbers(self):
        heights = np.array([[0, 7], [300, 65535]], np.uint16)
        image = imgmesh.Image(heights, values=True)
        np.testing.assert_array_equal(np.asarray(image), heights)
        self.assertEqual((image.dtype, image.channel_names), (np.float32, ("value",)))
        mesh = imgmesh.build(heights, values=True, density=100)
        np.testing.assert_allclose(np.asarray(mesh.reconstruct()), heights, atol=0.02)
        self.assertIsNone(mesh.colors)

    def test_masked(self):
        mask = np.zeros((32, 48), bool)
        mask[4:20, 6:30] = True
        mesh = imgmesh.build(ramp(), mask=mask, density=10)
        np.testing.assert_array_equal(mesh.mask, mask)
        np.testing.assert_array_equal(mesh.face_ids == imgmesh.NO_FACE, ~mask)
        self.assertTrue(mesh.has_mask)
        np.testing.assert_array_equal(mesh.segment().labels == imgmesh.NO_FACE, ~mask)


def lightness(rgb):
    """L* from 0 to 1 of encoded sRGB."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    y = linear @ [0.2126, 0.7152, 0.0722]
    return (1.16 * np.cbrt(y) - 0.16) if y > 0.008856 else 9.033 * y


if __name__ == "__main__":
    unittest.main()
