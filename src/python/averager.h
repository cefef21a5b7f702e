#pragma once

#include <memory>
#include <optional>
#include <string>

#include "lowlap/averaging/translation_problem.h"
#include "python/call.h"

namespace lowlap::python {

/// The request that a text is, or that averager() made a strategy of; nullopt
/// for anything else.
std::optional<std::string> RequestOf(py::handle strategy);

/// The averager of a request ("lud:loss_width=1e-4"), or one that is an object
/// of a class written in Python; that one lives no longer than the call.
std::shared_ptr<const TranslationAverager> AveragerOf(
    const py::object& strategy, Call* call);

}  // namespace lowlap::python
