#include "lowlap/study/internal/trust/table.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "lowlap/core/internal/joined.h"
#include "lowlap/report/internal/table_text.h"

namespace lowlap {
namespace {

using TrustJson = nlohmann::ordered_json;

std::string NumberOrNothing(double value) {
  return std::isfinite(value) ? NumberText(value, 6) : "";
}

std::optional<TrustFamily> FamilyFromName(const std::string& name) {
  for (const TrustFamily family : AllTrustFamilies()) {
    if (name == TrustFamilyName(family)) return family;
  }
  return std::nullopt;
}

std::optional<ViewGrade> GradeFromName(const std::string& name) {
  for (const ViewGrade grade :
       {ViewGrade::kUnplaced, ViewGrade::kDoubtful, ViewGrade::kFirm}) {
    if (name == ViewGradeName(grade)) return grade;
  }
  return std::nullopt;
}

// Throws what is no view.
JudgedView ViewFrom(const TrustJson& json) {
  JudgedView judged;
  json.at("view").get_to(judged.view);
  judged.graded.grade = GradeFromName(json.at("grade")).value();
  json.at("reasons").get_to(judged.graded.reasons);
  const TrustJson& error = json.at("error");
  judged.error = error.is_null() ? HUGE_VAL : error.get<double>();
  json.at("deviation").get_to(judged.deviation);
  return judged;
}

}  // namespace

std::string ToJsonLine(const TrustKey& key, const TrustTrial& trial) {
  TrustJson views = TrustJson::array();
  for (const JudgedView& judged : trial.views) {
    views.push_back({{"view", judged.view},
                     {"grade", ViewGradeName(judged.graded.grade)},
                     {"reasons", judged.graded.reasons},
                     {"error", judged.error},  // infinite: null
                     {"deviation", judged.deviation}});
  }
  const TrustJson json = {{"family", TrustFamilyName(key.first)},
                          {"seed", key.second},
                          {"labels", trial.labels},
                          {"failure", trial.failure},
                          {"triplets", trial.num_triplets},
                          {"meaningful", trial.num_meaningful},
                          {"doubtful", trial.is_doubtful},
                          {"views", std::move(views)}};
  return json.dump(-1, ' ', false, TrustJson::error_handler_t::replace);
}

bool AddJsonLine(const std::string& line, TrustStudy* study) {
  try {
    const TrustJson json = TrustJson::parse(line);
    const auto family = FamilyFromName(json.at("family"));
    if (!family) return false;
    TrustTrial trial;
    json.at("labels").get_to(trial.labels);
    json.at("failure").get_to(trial.failure);
    json.at("triplets").get_to(trial.num_triplets);
    json.at("meaningful").get_to(trial.num_meaningful);
    json.at("doubtful").get_to(trial.is_doubtful);
    for (const TrustJson& view : json.at("views")) {
      trial.views.push_back(ViewFrom(view));
    }
    const TrustKey key = {*family, json.at("seed").get<std::uint64_t>()};
    study->trials[key] = std::move(trial);
    return true;
  } catch (const TrustJson::exception&) {
    return false;
  } catch (const std::bad_optional_access&) {
    return false;
  }
}

std::string CamerasCsv(const TrustStudy& study) {
  TextTable table;
  table.columns = {"family", "seed",    "labels", "failure",  "view",
                   "grade",  "reasons", "error",  "deviation"};
  for (const auto& [key, trial] : study.trials) {
    for (const JudgedView& judged : trial.views) {
      table.rows.push_back(
          {TrustFamilyName(key.first), std::to_string(key.second),
           Joined(trial.labels, "; "), trial.failure,
           std::to_string(judged.view.value()),
           ViewGradeName(judged.graded.grade),
           Joined(judged.graded.reasons, "; "), NumberOrNothing(judged.error),
           judged.deviation > 0 ? NumberOrNothing(judged.deviation) : ""});
    }
  }
  return ToCsv(table);
}

}  // namespace lowlap
