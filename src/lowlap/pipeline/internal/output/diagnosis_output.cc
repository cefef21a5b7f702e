#include "lowlap/pipeline/internal/output/diagnosis_output.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/view_json.h"
#include "lowlap/pipeline/internal/output/summary_json.h"

namespace lowlap {
namespace {

using Json = nlohmann::ordered_json;

class DiagnosisWriter {
 public:
  DiagnosisWriter(const Diagnosis& diagnosis, const Scene& scene)
      : diagnosis_(diagnosis), scene_(scene) {}

  std::string Names(const std::vector<ViewId>& views) const {
    return Joined(views, ", ",
                  [this](ViewId view) { return scene_.NameOf(view); });
  }

  std::string Ratio(std::size_t index) const {
    const ScaleRatio& ratio = scene_.scale_ratios[index];
    const int inliers = ratio.NumInliers();
    return scene_.NameOf(ratio.views.first) + " - " +
           scene_.NameOf(ratio.views.middle) + " - " +
           scene_.NameOf(ratio.views.last) + " (" + std::to_string(inliers) +
           (inliers == 1 ? " inlier" : " inliers") + ", +-" +
           Format("%.2g", 100 * ratio.log_ratio_stddev) + " %, log10 NFA " +
           Format("%.1f", ratio.log10_nfa) + ")";
  }

  std::string Verdict() const {
    const std::size_t views = scene_.views.size();
    const RigidityReport& groups = diagnosis_.by_ratios;
    if (diagnosis_.IsFirm()) {
      return "firm: all " + std::to_string(views) + " views share one scale";
    }
    if (groups.groups.empty()) return "no two views have a relative pose";
    if (diagnosis_.floating.empty()) {
      return "not firm: all " + std::to_string(views) +
             " views share one scale, but only through weak ratios";
    }
    return "not firm: one scale for " +
           std::to_string(groups.groups[0].views.size()) + " of " +
           std::to_string(views) + " views";
  }

  std::string Floating(const FloatingPart& part) const {
    std::string text = "  " + Names(part.views) + ": ";
    if (part.meets_in == kInvalidId) {
      return text + "no relative pose joins " +
             (part.views.size() == 1 ? "it" : "them") + " to any other view";
    }
    text += "joined to other views in " + scene_.NameOf(part.meets_in) +
            ", and no ratio across it is meaningful";
    if (part.rejected_ratio) {
      text += "; the best: " + Ratio(*part.rejected_ratio);
    }
    return text;
  }

  std::string HingeText(const ScaleArticulation& hinge) const {
    std::string text = "  on " + scene_.NameOf(hinge.view) + " hang ";
    for (std::size_t n = 1; n < hinge.parts.size(); ++n) {
      text += (n > 1 ? " | " : "") + Names(hinge.parts[n]);
    }
    text += ", by " + std::to_string(hinge.ratios.size()) +
            (hinge.ratios.size() == 1 ? " ratio: " : " ratios, the best: ");
    return text + Ratio(hinge.ratios.front()) + (hinge.is_weak ? " WEAK" : "");
  }

  std::string Triplets() const {
    const TripletPrediction& triplets = diagnosis_.by_triplets;
    if (triplets.kept.empty()) {
      return "  would fail: no three views share enough point tracks\n";
    }
    std::string text = "  would keep " + std::to_string(triplets.kept.size()) +
                       " of " + std::to_string(scene_.views.size()) + " views";
    if (!triplets.lost.empty()) text += ", without " + Names(triplets.lost);
    text += "\n";
    if (!triplets.IsGlued()) return text + "  and have one scale for them\n";
    text += "  and put together " + std::to_string(triplets.groups.size()) +
            " groups that are joined by one camera each, at an arbitrary "
            "scale, without a warning:\n";
    for (const RigidGroup& group : triplets.groups) {
      text += "    " + Names(group.views) + "\n";
    }
    for (const ArticulationView& hinge : triplets.articulation_views) {
      text += "    joined in " + scene_.NameOf(hinge.view) + "\n";
    }
    return text;
  }

  // What would mend it, a sentence each.
  std::vector<std::string> Advice() const {
    std::vector<std::string> advice;
    std::set<ViewId> hinges;
    for (const FloatingPart& part : diagnosis_.floating) {
      if (part.near_group == kInvalidId) continue;
      if (part.meets_in == kInvalidId) {
        advice.push_back(
            "Two photographs between " + scene_.NameOf(part.near_group) +
            " and " + scene_.NameOf(part.near_part) +
            " (the nearest by number; any other place where the parts come "
            "close will do), each overlapping both by more than half; or one, "
            "if the walls or fronts it shares with either are the same.");
      } else {
        hinges.insert(part.meets_in);
        advice.push_back(
            Across(part.near_group, part.meets_in, part.near_part));
      }
    }
    for (const ScaleArticulation& hinge : diagnosis_.articulation_views) {
      if (!hinge.is_weak || !hinges.insert(hinge.view).second) continue;
      const ViewTriplet& views = scene_.scale_ratios[hinge.ratios[0]].views;
      advice.push_back(Across(views.first, views.middle, views.last));
    }
    for (const std::size_t r : diagnosis_.weak_ratios) {
      const ViewTriplet& views = scene_.scale_ratios[r].views;
      if (!hinges.insert(views.middle).second) continue;
      advice.push_back(Across(views.first, views.middle, views.last));
    }
    return advice;
  }

 private:
  std::string Across(ViewId a, ViewId middle, ViewId b) const {
    return "At " + scene_.NameOf(middle) +
           ": one photograph from nearby that overlaps " + scene_.NameOf(a) +
           ", " + scene_.NameOf(middle) + " and " + scene_.NameOf(b) +
           "; or one that shows what " + scene_.NameOf(a) + " - " +
           scene_.NameOf(middle) + " and " + scene_.NameOf(middle) + " - " +
           scene_.NameOf(b) +
           " both see, since three views of a few points or lines, or lines of "
           "one wall matched in both pairs, fix the scale.";
  }

  const Diagnosis& diagnosis_;
  const Scene& scene_;
};

void AddGroups(const DiagnosisWriter& writer, const RigidityReport& report,
               std::string* text) {
  if (report.groups.size() > 1) {
    for (std::size_t g = 0; g < report.groups.size(); ++g) {
      *text += "  group " + std::to_string(g + 1) + ", " +
               std::to_string(report.groups[g].views.size()) +
               " views: " + writer.Names(report.groups[g].views) + "\n";
    }
  } else if (report.groups.size() == 1) {
    *text += "  all of: " + writer.Names(report.groups[0].views) + "\n";
  }
}

}  // namespace

std::string ToText(const Diagnosis& diagnosis, const Scene& scene) {
  const DiagnosisWriter writer(diagnosis, scene);
  std::string text = writer.Verdict() + "\n";
  if (diagnosis.by_ratios.groups.empty()) return text;
  const std::size_t by_directions = diagnosis.by_directions.groups.size();
  text +=
      by_directions == 1
          ? "\nviews that share a scale, by the directions of their relative "
            "poses alone:\n"
          : "\nviews that share a scale, by directions and ratios (directions "
            "alone leave " +
                std::to_string(by_directions) +
                " groups); where groups meet, a view is in each:\n";
  AddGroups(writer, diagnosis.by_ratios, &text);
  const auto section = [&](const std::string& title,
                           const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    text += "\n" + title + ":\n";
    for (const std::string& line : lines) text += line + "\n";
  };
  std::vector<std::string> floating, hinges, weak, advice;
  for (const FloatingPart& part : diagnosis.floating) {
    floating.push_back(writer.Floating(part));
  }
  for (const ScaleArticulation& hinge : diagnosis.articulation_views) {
    hinges.push_back(writer.HingeText(hinge));
  }
  for (const std::size_t r : diagnosis.weak_ratios) {
    weak.push_back("  " + writer.Ratio(r));
  }
  for (const std::string& sentence : writer.Advice()) {
    advice.push_back("  " + sentence);
  }
  if (!diagnosis.articulation_views.empty() || !diagnosis.weak_ratios.empty() ||
      !diagnosis.floating.empty()) {
    text +=
        "\nA ratio a - b - c says how long b to c is, measured by a to b. "
        "Inliers are the\npoints, lines and pairs of lines that agree on it, "
        "+- is its deviation, and log10\nNFA how often chance does as well: "
        "0 once, -3 in one of a thousand cases.\n";
  }
  section("floating, with a scale of their own", floating);
  section("hinges: one camera is all that holds these views", hinges);
  section("weak ratios that nothing else replaces", weak);
  section("what would mend it", advice);
  return text + "\naveraging over point triplets, as OpenMVG does,\n" +
         writer.Triplets();
}

std::string ToJson(const Diagnosis& diagnosis, const Scene& scene) {
  const DiagnosisWriter writer(diagnosis, scene);
  const auto triplet = [&](std::size_t r) {
    const ScaleRatio& ratio = scene.scale_ratios[r];
    return Json{{"views", ratio.views},
                {"inliers", ratio.NumInliers()},
                {"log_ratio_stddev", ratio.log_ratio_stddev},
                {"log10_nfa", ratio.log10_nfa}};
  };
  const auto triplets = [&](const std::vector<std::size_t>& ratios) {
    Json list = Json::array();
    for (const std::size_t r : ratios) list.push_back(triplet(r));
    return list;
  };
  Json json;
  json["firm"] = diagnosis.IsFirm();
  json["verdict"] = writer.Verdict();
  json["views"] = scene.views.size();
  json["by_directions"] = Json::parse(ToJson(diagnosis.by_directions));
  json["by_ratios"] = Json::parse(ToJson(diagnosis.by_ratios));
  json["by_strong_ratios"] = Json::parse(ToJson(diagnosis.by_strong_ratios));
  json["weak_ratios"] = triplets(diagnosis.weak_ratios);
  json["hinges"] = Json::array();
  for (const ScaleArticulation& hinge : diagnosis.articulation_views) {
    json["hinges"].push_back({{"view", hinge.view},
                              {"parts", hinge.parts},
                              {"ratios", triplets(hinge.ratios)},
                              {"weak", hinge.is_weak}});
  }
  json["floating"] = Json::array();
  for (const FloatingPart& part : diagnosis.floating) {
    Json entry = {{"views", part.views}};
    if (part.meets_in != kInvalidId) entry["meets_in"] = part.meets_in;
    if (part.near_group != kInvalidId) {
      entry["nearest"] = {part.near_group, part.near_part};
    }
    if (part.rejected_ratio) {
      entry["rejected_ratio"] = triplet(*part.rejected_ratio);
    }
    json["floating"].push_back(std::move(entry));
  }
  Json groups = Json::array();
  for (const RigidGroup& group : diagnosis.by_triplets.groups) {
    groups.push_back(group.views);
  }
  json["by_triplets"] = {{"kept", diagnosis.by_triplets.kept},
                         {"lost", diagnosis.by_triplets.lost},
                         {"groups", std::move(groups)},
                         {"glued", diagnosis.by_triplets.IsGlued()}};
  json["advice"] = writer.Advice();
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lowlap
