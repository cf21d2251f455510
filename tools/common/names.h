// The words of options and reports for the values of enums.
#pragma once

#include "formats/container/container.h"
#include "formats/picture/image_io.h"
#include "formats/picture/texture_file.h"
#include "libcore/coding/encode_picture.h"
#include "libcore/image/image.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/pipeline/build_source.h"
#include "libcore/recon/draw.h"
#include "libcore/segment/segment.h"
#include "tools/common/choices.h"

namespace imgmesh {

Choices<ColorSpace> color_space_choices();
Choices<WeightPrecision> bary_choices();
Choices<DracoMode> draco_choices();
Choices<LayerLayout> layer_choices();  ///< without kOff
Choices<SampleType> sample_type_choices();
Choices<DrawMode> draw_mode_choices();
Choices<DistanceRule> distance_choices();
Choices<SegmentQuality> segment_quality_choices();
Choices<AlphaUse> alpha_choices();
Choices<NonFinite> non_finite_choices();
Choices<TextureType> texture_type_choices();
Choices<Tune> tune_choices();

}  // namespace imgmesh
