#pragma once

#include <string>

#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A diagnosis in plain words, with image names: what shares a scale, what
/// floats, what hangs on one camera or on weak ratios, what averaging over
/// triplets would return, and which photographs would mend it.
std::string ToText(const Diagnosis& diagnosis, const Scene& scene);

/// The same for a program: ids, groups, hinges, ratios, and the advice.
std::string ToJson(const Diagnosis& diagnosis, const Scene& scene);

}  // namespace lowlap
