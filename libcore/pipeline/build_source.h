// From an image as it was read to what a build takes: the use of its alpha, its mask, its channels. Every
// program that builds does it alike through this file.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libcore/image/mask.h"
#include "libcore/pipeline/build.h"

namespace imgmesh {

/// What an alpha channel is to a build.
enum class AlphaUse {
    kAuto,   ///< kept if it is soft, else cut
    kKeep,   ///< a channel of the mesh
    kCut,    ///< a mask
    kIgnore  ///< nothing
};

/// Writes a parameter with its value as a program's user would, for the advice in messages.
using ParamText = std::function<std::string(std::string_view name, std::string_view value)>;

/// What is asked of an image's alpha.
struct AlphaParams {
    AlphaUse use = AlphaUse::kAuto;
    /// Least alpha, or brightness of a mask, of the pixels that are meshed; none: 1/2, or where alpha is kept
    /// whatever is not transparent (least_visible_alpha).
    std::optional<double> threshold;
};

/// What a build takes of an image, but for its mask.
struct SourcePlan {
    AlphaUse alpha = AlphaUse::kIgnore;  ///< never kAuto
    BuildParams params;                  ///< with the names that channels have once they are read
    double threshold = 0.5;              ///< as in AlphaParams
    std::vector<std::string> warnings;   ///< each one sentence without the file's name
};

/// Returns the channels to read for a build, as ReadImageOptions::channels: no more than are meshed. A
/// texture shows the colour also where other channels are meshed.
std::optional<std::vector<std::string>> channels_to_read(const BuildParams& params, bool texture);

/// Returns what becomes of an image and of the parameters of its build. Alpha that is kept becomes a channel;
/// refinement, which is for colour alone, is then left out with a warning, unless kKeep was asked for.
///
/// has_mask  whether another image is the mask; then alpha cuts nothing
SourcePlan plan_source(const Image& image, const AlphaParams& alpha, bool has_mask, const BuildParams& params,
                       const ParamText& text);

/// Returns the mask that the image's alpha is by `plan`; empty() for none. Throws Error(kUnsupported) if no
/// pixel is inside.
Mask source_mask(const Image& image, const SourcePlan& plan, const ParamText& text);

/// Returns the mask that `picture` is to `image`, which messages call `name`. Throws Error(kBadFile) if their
/// sizes differ, and Error(kUnsupported) if no pixel is inside, with the largest value there is.
Mask picture_mask(const Image& picture, const Image& image, const std::string& name, double threshold,
                  const ParamText& text);

/// What has put pixels outside a mask.
enum class MaskOrigin { kAlpha, kPicture, kNoData };

/// Adds to a result's parameters what its mask was made of, if it has one. Returns a warning, or "", on
/// samples of the colour that were clipped.
std::string note_source(BuildResult& result, MaskOrigin origin, double threshold, const ParamText& text);

}  // namespace imgmesh
