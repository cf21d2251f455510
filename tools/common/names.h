// The words by which options and reports call the values of enums.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "formats/container/container.h"
#include "libcore/image/image.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/simplify/metric.h"

namespace imgmesh {

template <typename Value>
using Choices = std::vector<std::pair<std::string, Value>>;

Choices<ColorSpace> color_space_choices();
Choices<WeightPrecision> bary_choices();
Choices<DracoMode> draco_choices();
Choices<SampleType> sample_type_choices();
Choices<Metric> metric_choices();
Choices<Solver> solver_choices();

/// The word of a value that is among the choices.
template <typename Value>
std::string name_of(const Choices<Value>& choices, Value value) {
    for (const auto& [name, candidate] : choices) {
        if (candidate == value) return name;
    }
    throw std::logic_error("a value without a name");
}

}  // namespace imgmesh
