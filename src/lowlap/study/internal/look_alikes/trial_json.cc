#include "lowlap/study/internal/look_alikes/trial_json.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace lowlap {
namespace {

using PairJson = nlohmann::ordered_json;

}  // namespace

std::string ToJsonLine(const LookAlikeKey& key, const LookAlikeTrial& trial) {
  const auto& [kind, is_same_place, seed] = key;
  const PairJson json = {{"kind", RepeatedKindName(kind)},
                         {"same_place", is_same_place},
                         {"seed", seed},
                         {"accepted", trial.is_accepted},
                         {"log10_nfa", trial.log10_nfa},
                         {"rotation_error_deg", trial.rotation_error_deg},
                         {"direction_error_deg", trial.direction_error_deg},
                         {"reason", trial.reason}};
  return json.dump(-1, ' ', false, PairJson::error_handler_t::replace);
}

bool AddJsonLine(const std::string& line, LookAlikeStudy* study) {
  try {
    const PairJson json = PairJson::parse(line);
    const std::optional<RepeatedKind> kind =
        RepeatedKindFromName(json.at("kind"));
    if (!kind) return false;
    LookAlikeTrial trial;
    json.at("accepted").get_to(trial.is_accepted);
    json.at("log10_nfa").get_to(trial.log10_nfa);
    json.at("rotation_error_deg").get_to(trial.rotation_error_deg);
    json.at("direction_error_deg").get_to(trial.direction_error_deg);
    json.at("reason").get_to(trial.reason);
    const LookAlikeKey key = {*kind, json.at("same_place").get<bool>(),
                              json.at("seed").get<std::uint64_t>()};
    study->trials[key] = trial;
    return true;
  } catch (const PairJson::exception&) {
    return false;
  }
}

}  // namespace lowlap
