#include <nlohmann/json.hpp>

#include "lowlap/evaluation/pose_errors.h"

namespace lowlap {
namespace {

using Json = nlohmann::ordered_json;

std::string Dump(const Json& json) {
  // File names may hold any bytes; what is not UTF-8 is replaced.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string ToJson(const PoseEvaluation& evaluation) {
  Json views = Json::array();
  for (const ViewPoseError& error : evaluation.views) {
    Json view = {{"view", error.view}, {"name", error.name}};
    if (evaluation.scope == EvaluationScope::kFull) {
      view["position_error"] = error.position_error;
    }
    if (evaluation.scope != EvaluationScope::kNothing) {
      view["rotation_error_deg"] = error.rotation_error_deg;
    }
    views.push_back(std::move(view));
  }
  Json json = {{"scope", EvaluationScopeName(evaluation.scope)},
               {"note", evaluation.note},
               {"num_total", evaluation.num_total},
               {"num_solved", evaluation.num_solved},
               {"unsolved", evaluation.unsolved},
               {"without_truth", evaluation.without_truth}};
  if (evaluation.scope == EvaluationScope::kFull) {
    json["position"] = evaluation.position;
    json["scale"] = evaluation.truth_from_solution.scale;
    json["frame_disagreement_deg"] = evaluation.frame_disagreement_deg;
  }
  if (evaluation.scope != EvaluationScope::kNothing) {
    json["rotation_deg"] = evaluation.rotation_deg;
  }
  json["views"] = std::move(views);
  return Dump(json);
}

}  // namespace lowlap
