#include "python/averager.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "lowlap/averaging/averager_registry.h"
#include "lowlap/averaging/scene_poses.h"
#include "python/arrays.h"
#include "python/keywords.h"

namespace lowlap::python {
namespace {

// Component 0 has the most views; of equals, the one of the first view.
void SortComponents(TranslationSolution* solution) {
  std::vector<int> sizes;
  for (const int component : solution->component) {
    if (component < 0) continue;
    if (component >= static_cast<int>(sizes.size())) {
      sizes.resize(component + 1);
    }
    ++sizes[component];
  }
  std::vector<int> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return sizes[a] > sizes[b]; });
  std::vector<int> rank(sizes.size());
  for (std::size_t n = 0; n < order.size(); ++n) {
    rank[order[n]] = static_cast<int>(n);
    if (sizes[order[n]] > 0) ++solution->num_components;
  }
  for (int& component : solution->component) {
    if (component >= 0) component = rank[component];
  }
}

// Centres, n x 3 with NaN for what is not placed; or them and the component of
// every view.
std::optional<TranslationSolution> ReadSolution(const py::object& returned,
                                                std::size_t num_views) {
  py::object centers = returned;
  std::vector<int> components(num_views, 0);
  if (py::isinstance<py::tuple>(returned) && py::len(returned) == 2) {
    const auto both = returned.cast<py::tuple>();
    centers = both[0];
    try {
      components = both[1].cast<std::vector<int>>();
    } catch (const py::cast_error&) {
      return std::nullopt;
    }
  }
  using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const Array array = Array::ensure(centers);
  if (!array || array.ndim() != 2 || array.shape(1) != 3 ||
      array.shape(0) != static_cast<py::ssize_t>(num_views) ||
      components.size() != num_views) {
    PyErr_Clear();
    return std::nullopt;
  }
  TranslationSolution solution;
  for (std::size_t v = 0; v < num_views; ++v) {
    const double* row = array.data(static_cast<py::ssize_t>(v), 0);
    const Vec3 center(row[0], row[1], row[2]);
    // A component per view at most: greater numbers are a mistake.
    if (components[v] >= static_cast<int>(num_views)) return std::nullopt;
    const bool is_placed = components[v] >= 0 && center.allFinite();
    solution.component.push_back(is_placed ? components[v] : -1);
    solution.center_in_world.push_back(is_placed ? center : Vec3::Zero());
  }
  SortComponents(&solution);
  return solution;
}

// What a method of a strategy returns; TypeError if it is of another type.
template <class T>
T Answer(const py::object& strategy, const char* method) {
  const py::object returned = strategy.attr(method)();
  try {
    return returned.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(method) + "() of a strategy cannot be " +
                         py::repr(returned).cast<std::string>());
  }
}

// A strategy that is written in Python.
class PythonAverager final : public TranslationAverager {
 public:
  PythonAverager(py::object strategy, Call* call)
      : strategy_(std::move(strategy)),
        call_(call),
        name_(Answer<std::string>(strategy_, "name")),
        needs_tracks_(Answer<bool>(strategy_, "needs_tracks")),
        needs_(Answer<std::string>(strategy_, "needs")) {}

  std::string Name() const override { return name_; }
  bool NeedsTracks() const override { return needs_tracks_; }
  std::string Needs() const override { return needs_; }

  // A lowlap.Error is a result as another; any other exception ends the call.
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext&) const override {
    Result<TranslationSolution> result =
        MakeError(ErrorCode::kCancelled, "stopped on request", {}, name_);
    call_->CallBack([&] {
      try {
        // A copy, for whatever of it Python keeps.
        auto solution =
            ReadSolution(strategy_.attr("solve")(
                             std::make_shared<TranslationProblem>(problem)),
                         problem.views.size());
        if (solution) {
          result = std::move(*solution);
        } else {
          result = MakeError(
              ErrorCode::kInvalidArgument,
              name_ +
                  ": solve must return an array of centres, a row for each "
                  "view, or such an array and the components of the views");
        }
      } catch (const py::error_already_set& exception) {
        if (!IsError(exception)) throw;
        result = tl::unexpected<Error>(ErrorOf(exception));
      }
      return true;
    });
    return result;
  }

 private:
  py::object strategy_;
  Call* call_;
  std::string name_;
  bool needs_tracks_;
  std::string needs_;
};

// One of lowlap's own, for Python.
struct BuiltInAverager {
  std::string request;
  std::shared_ptr<const TranslationAverager> averager;
};

BuiltInAverager MakeBuiltIn(const std::string& request) {
  return {request, ValueOf(AveragerRegistry::WithBuiltIns().Make(request))};
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

std::pair<Rows, std::vector<int>> SolveProblem(
    const BuiltInAverager& built_in, const TranslationProblem& problem,
    const py::kwargs& kwargs) {
  Keywords keywords("solve", kwargs);
  const auto call = TakeCall(&keywords);
  keywords.Finish();
  TranslationSolution solution = call->Run(
      [&] { return built_in.averager->Solve(problem, call->context()); });
  Rows centers(solution.component.size(), 3);
  for (std::size_t v = 0; v < solution.component.size(); ++v) {
    if (solution.component[v] >= 0) {
      centers.row(v) = solution.center_in_world[v];
    } else {
      centers.row(v).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return {std::move(centers), std::move(solution.component)};
}

// The problem of a scene, as a strategy gets it.
std::shared_ptr<TranslationProblem> ProblemOf(const py::object& scene_or_path,
                                              const py::kwargs& kwargs) {
  Keywords keywords("translation_problem", kwargs);
  const auto call = TakeCall(&keywords);
  bool with_tracks = false;
  keywords.Take("with_tracks", &with_tracks);
  keywords.Finish();
  const auto scene = MeasuredSceneOf(scene_or_path, {}, call.get()).scene;
  return call->Run([&]() -> Result<std::shared_ptr<TranslationProblem>> {
    const auto rotations =
        AverageSceneRotations(*scene, PoseOptions(), call->context());
    if (!rotations) return tl::unexpected<Error>(rotations.error());
    return std::make_shared<TranslationProblem>(
        MakeTranslationProblem(*scene, rotations->cam_from_world,
                               PairsOf(rotations->outliers), {}, with_tracks));
  });
}

// Indices, signed: numpy makes floats of unsigned ones in calculations.
const std::int64_t* Signed(const std::size_t* indices) {
  static_assert(sizeof(std::int64_t) == sizeof(std::size_t));
  return reinterpret_cast<const std::int64_t*>(indices);
}

py::list TracksOf(const py::object& self) {
  py::list tracks;
  for (const TrackRays& track : self.cast<const TranslationProblem&>().tracks) {
    const auto& rays = track.observations;
    const RayObservation* first = rays.data();
    tracks.append(py::make_tuple(
        MemberArray(rays, first ? Signed(&first->view) : nullptr, 0, self),
        MemberArray(rays, first ? first->ray_in_world.data() : nullptr, 3,
                    self)));
  }
  return tracks;
}

// An array on a member of the problem's edges or ratios.
template <class Element, class Member>
auto ArrayOf(const std::vector<Element> TranslationProblem::*elements,
             Member member, std::size_t columns) {
  return [=](const py::object& self) {
    const auto& all = self.cast<const TranslationProblem&>().*elements;
    using T = std::remove_pointer_t<decltype(member(all.front()))>;
    T* first = all.empty() ? nullptr : member(all.front());
    return MemberArray(all, first, columns, self);
  };
}

}  // namespace

std::optional<std::string> RequestOf(py::handle strategy) {
  if (py::isinstance<py::str>(strategy)) return strategy.cast<std::string>();
  if (py::isinstance<BuiltInAverager>(strategy)) {
    return strategy.cast<const BuiltInAverager&>().request;
  }
  return std::nullopt;
}

std::shared_ptr<const TranslationAverager> AveragerOf(
    const py::object& strategy, Call* call) {
  if (const auto request = RequestOf(strategy)) {
    return MakeBuiltIn(*request).averager;
  }
  if (!py::isinstance(
          strategy,
          py::module_::import("lowlap._base").attr("TranslationAverager"))) {
    throw py::type_error("a strategy is a text or a TranslationAverager, not " +
                         py::repr(strategy).cast<std::string>());
  }
  return std::make_shared<PythonAverager>(strategy, call);
}

void BindAveraging(py::module_& module) {
  using Problem = TranslationProblem;
  py::class_<Problem, std::shared_ptr<Problem>>(
      module, "TranslationProblem",
      "What an averaging strategy gets. Views are rows; edges are measured\n"
      "directions, C_second - C_first = length direction; a ratio says\n"
      "log length(target) - log length(reference). Arrays are not copies.")
      .def_property_readonly(
          "views",
          [](const py::object& self) {
            return IndexArray(self.cast<const Problem&>().views, self);
          },
          "Ids, (n,).")
      .def_property_readonly(
          "rotations",
          [](const py::object& self) {
            const auto& all = self.cast<const Problem&>().cam_from_world;
            return ArrayOn(all.empty() ? nullptr : all.front().data(),
                           {static_cast<py::ssize_t>(all.size()), 3, 3},
                           // Matrices are stored by columns.
                           {sizeof(Mat3), sizeof(double), 3 * sizeof(double)},
                           self);
          },
          "Camera from world, (n, 3, 3).")
      .def_property_readonly(
          "edges",
          ArrayOf(
              &Problem::edges, [](auto& edge) { return Signed(&edge.first); },
              2),
          "First and second view as rows of `views`, (m, 2).")
      .def_property_readonly(
          "directions",
          ArrayOf(
              &Problem::edges,
              [](auto& edge) { return edge.direction_in_world.data(); }, 3),
          "Unit directions in the world frame, (m, 3).")
      .def_property_readonly(
          "direction_stddevs",
          ArrayOf(
              &Problem::edges, [](auto& edge) { return &edge.stddev_rad; }, 0),
          "Standard deviations of the directions in radians, (m,).")
      .def_property_readonly(
          "ratios",
          ArrayOf(
              &Problem::ratios,
              [](auto& ratio) { return Signed(&ratio.reference); }, 2),
          "Reference and target as rows of `edges`, (k, 2).")
      .def_property_readonly(
          "log_ratios",
          ArrayOf(
              &Problem::ratios, [](auto& ratio) { return &ratio.log_ratio; },
              0),
          "(k,).")
      .def_property_readonly(
          "ratio_stddevs",
          ArrayOf(
              &Problem::ratios, [](auto& ratio) { return &ratio.stddev; }, 0),
          "Standard deviations of the log ratios, (k,).")
      .def_property_readonly(
          "tracks", &TracksOf,
          "Of each point track: rows of `views`, and rays in the world frame.\n"
          "Empty unless the strategy needs tracks.");

  py::class_<BuiltInAverager>(module, "BuiltInAverager",
                              "A strategy of lowlap; see averager().")
      .def("name", [](const BuiltInAverager& b) { return b.averager->Name(); })
      .def("needs",
           [](const BuiltInAverager& b) { return b.averager->Needs(); })
      .def("needs_tracks",
           [](const BuiltInAverager& b) { return b.averager->NeedsTracks(); })
      .def("solve", &SolveProblem, py::arg("problem"),
           "Centres (NaN: not placed) and components (-1: not placed) of the\n"
           "views. Options: threads, seed, progress, log.");

  module.def(
      "averager", &MakeBuiltIn, py::arg("strategy"),
      "A strategy of lowlap by NAME or NAME:key=value,...; strategies() lists\n"
      "them.");
  module.def(
      "strategies",
      [] {
        std::map<std::string, std::string> described;
        const auto registry = AveragerRegistry::WithBuiltIns();
        for (const auto& each : registry.strategies()) {
          described[each.name] = each.description;
        }
        return described;
      },
      "The averaging strategies of lowlap: descriptions by name.");
  module.def("translation_problem", &ProblemOf, py::arg("scene"),
             "The averaging problem of a scene, from its relative poses and\n"
             "meaningful scale ratios. Options: with_tracks, threads, seed,\n"
             "progress, log.");
}

}  // namespace lowlap::python
