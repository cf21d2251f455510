"""Pictures of our own: three drawings with flat colours and three smooth pictures, made on the spot."""
import math

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

WIDTH, HEIGHT = 512, 384
FINE = 4  # drawings are made that many times larger and averaged, so that edges are smooth
BLUR = 6  # standard deviation of blurred photographs [pixels]


class Canvas:
    """Draws in pixels of the finished picture."""

    def __init__(self, ground):
        self.image = Image.new("RGB", (WIDTH * FINE, HEIGHT * FINE), ground)
        self.draw = ImageDraw.Draw(self.image)

    def shape(self, points, fill, line=None, width=0):
        scaled = [(x * FINE, y * FINE) for x, y in points]
        self.draw.polygon(scaled, fill)
        if line:
            self.stroke([*points, points[0]], line, width)

    def stroke(self, points, fill, width):
        self.draw.line([(x * FINE, y * FINE) for x, y in points], fill, round(width * FINE), joint="curve")
        for x, y in points:
            self.disc(x, y, width / 2, fill)

    def disc(self, x, y, radius, fill, line=None, width=0):
        for r, color in ((radius, line or fill), (radius - width, fill)):
            self.draw.ellipse([(x - r) * FINE, (y - r) * FINE, (x + r) * FINE, (y + r) * FINE], color)

    def finished(self):
        return self.image.reduce(FINE)


def curve(start, end, count, height):
    """Points over x from start to end."""
    return [(x, height(x)) for x in np.linspace(start, end, count).tolist()]


def logo():
    c = Canvas("#ffffff")
    c.disc(256, 170, 130, "#12355b")
    c.disc(256, 170, 104, "#f4f1de")
    c.shape([(256, 84), (332, 214), (180, 214)], "#e07a5f")
    c.shape([(256, 136), (294, 202), (218, 202)], "#f2cc8f")
    c.disc(322, 108, 22, "#3d9970")
    for k, left in enumerate(range(116, 396, 56)):  # a word of strokes
        c.stroke([(left, 364), (left, 322), (left + 36, 322 if k % 2 else 364)], "#12355b", 9)
        c.stroke([(left, 343), (left + 30, 343)], "#12355b", 9)
    return c.finished()


def chart():
    """A map: land, a lake, woods, a river and roads."""
    c = Canvas("#a6cee3")
    coast = curve(0, WIDTH, 120, lambda x: 95 + 30 * math.sin(x / 47) + 14 * math.sin(x / 17 + 1) + 5 * math.sin(x / 6))
    c.shape([*coast, (WIDTH, HEIGHT), (0, HEIGHT)], "#f0ead2")
    c.stroke(coast, "#7a9e9f", 2)
    for x, y, size in ((90, 220, 52), (330, 300, 64), (430, 190, 38)):
        wood = [(x + size * (1 + 0.18 * math.sin(5 * t)) * math.cos(t),
                 y + 0.7 * size * (1 + 0.2 * math.cos(3 * t)) * math.sin(t)) for t in np.linspace(0, 2 * math.pi, 60).tolist()]
        c.shape(wood, "#b5c99a")
    c.stroke(curve(0, WIDTH, 90, lambda x: 310 - 0.16 * x + 20 * math.sin(x / 40)), "#1f78b4", 4)
    for k in range(6):
        c.stroke([(40 + 84 * k, 150 + 8 * k), (20 + 92 * k, HEIGHT)], "#ffffff", 5)
    c.stroke(curve(0, WIDTH, 60, lambda x: 250 + 26 * math.sin(x / 70 + 2)), "#e29578", 7)
    c.stroke(curve(0, WIDTH, 60, lambda x: 250 + 26 * math.sin(x / 70 + 2)), "#ffddd2", 4)
    for k in range(14):
        c.disc(30 + 37 * k, 250 + 26 * math.sin((30 + 37 * k) / 70 + 2), 5, "#ffffff", "#444444", 1.5)
    return c.finished()


def comic():
    """A face with black outlines before a sky with rays."""
    c, ink = Canvas("#ffd166"), "#1a1a1a"
    for k in range(0, 24, 2):
        rays = [2 * math.pi * (k + j) / 24 for j in (0, 1)]
        c.shape([(256, 200), *((256 + 420 * math.cos(a), 200 + 420 * math.sin(a)) for a in rays)], "#ffb703")
    c.shape([(110, HEIGHT), (150, 300), (256, 270), (362, 300), (402, HEIGHT)], "#457b9d", ink, 5)
    c.disc(256, 180, 108, "#f6c9a8", ink, 5)
    c.shape([(150, 170), (168, 92), (226, 58), (300, 62), (350, 108), (362, 176), (330, 120), (256, 104), (190, 118)],
            "#6f1d1b", ink, 5)
    for x in (216, 300):
        c.disc(x, 172, 20, "#ffffff", ink, 4)
        c.disc(x + 4, 176, 8, ink)
    c.stroke(curve(206, 306, 24, lambda x: 222 + 26 * math.sqrt(max(0.0, 1 - ((x - 256) / 50) ** 2))), ink, 6)
    c.stroke([(256, 178), (246, 208), (262, 210)], ink, 4)
    c.shape([(380, 40), (492, 40), (492, 108), (430, 108), (404, 140), (408, 108), (380, 108)], "#ffffff", ink, 4)
    for k in range(3):
        c.stroke([(396, 58 + 17 * k), (476 - 18 * (k == 2), 58 + 17 * k)], ink, 4)
    return c.finished()


def lights():
    """Coloured lights that fade into each other."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    light = 0.1 + np.stack([x / WIDTH, y / HEIGHT, 1 - x / WIDTH], axis=-1) * 0.25
    for at_x, at_y, reach, color in ((120, 90, 90, (0.7, 0.2, 0.1)), (380, 130, 120, (0.1, 0.45, 0.5)),
                                     (240, 290, 70, (0.5, 0.5, 0.1)), (450, 330, 60, (0.4, 0.1, 0.5))):
        fade = np.exp(-((x - at_x) ** 2 + (y - at_y) ** 2) / (2 * reach ** 2))
        light = light + fade[..., None] * color
    return Image.fromarray(np.floor(np.clip(light, 0, 1) * 255 + 0.5).astype(np.uint8))


def drawings():
    return {"logo": logo(), "map": chart(), "comic": comic()}


def smooth(photographs):
    """Lights, and two of the photographs blurred."""
    names = list(photographs)
    return {"lights": lights()} | {f"{name}-blurred": photographs[name].filter(ImageFilter.GaussianBlur(BLUR))
                                   for name in dict.fromkeys((names[0], names[-1]))}
