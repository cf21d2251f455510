// Text in images. Target imgmesh_pictures.
#pragma once

#include <string>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

enum class TextAlign { kLeft, kCenter, kRight };

/// A line of UTF-8 text; (x, y) is the start, middle or end of its baseline [pixels].
struct TextLabel {
    int x = 0;
    int y = 0;
    int size = 12;  ///< height of the font [pixels]
    TextAlign align = TextAlign::kLeft;
    Vec3f color = Vec3f::Zero();  ///< as encoded in the image
    std::string text;
};

/// Draws the labels over an RGB image in DejaVu Sans; parts outside are cut off. Throws Error(kUnsupported)
/// if that font is not installed.
void draw_text(Image& image, const std::vector<TextLabel>& labels);

}  // namespace imgmesh
