// The words of options and reports for the values of enums.
#pragma once

#include "formats/container/container.h"
#include "libcore/image/image.h"
#include "libcore/mesh/pixel_map.h"
#include "tools/common/choices.h"

namespace imgmesh {

Choices<ColorSpace> color_space_choices();
Choices<WeightPrecision> bary_choices();
Choices<DracoMode> draco_choices();
Choices<SampleType> sample_type_choices();

}  // namespace imgmesh
