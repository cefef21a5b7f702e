#include "lowlap/report/internal/page_data.h"

#include <algorithm>

#include "lowlap/report/internal/page_parts.h"

namespace lowlap {
namespace {

PageJson WarningsJson(const ReportContent& content, const PageIndex& index) {
  PageJson warnings = PageJson::array();
  for (const ReportWarning& warning : content.warnings) {
    PageJson views = PageJson::array();
    for (const ViewId view : warning.views) {
      views.push_back(index.views.at(view));
    }
    warnings.push_back({{"text", warning.text}, {"views", std::move(views)}});
  }
  return warnings;
}

// A "<" could end the element that the data stand in, or begin a comment; in
// JSON it occurs within strings only.
std::string WithoutMarkup(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

std::string PageData(const Scene& scene, const ReportContent& content,
                     const PageLimits& limits) {
  const PageIndex index = MakePageIndex(scene, limits);
  const DisplayFrame frame = ChooseDisplayFrame(scene);
  std::optional<ReportStage> before;
  if (content.before_adjustment) {
    before = AlignToScene(*content.before_adjustment, scene);
  }
  PageJson page = {{"title", content.title}, {"figures", content.figures}};
  page["warnings"] = WarningsJson(content, index);
  page["notes"] = content.notes;
  page["views"] = ViewsJson(scene, content, before, index, frame, limits);
  AddStructure(scene, before, index, frame, &page);
  page["pairs"] = PairsJson(scene, content, index, limits);
  page["triplets"] = TripletsJson(scene, content, index, limits);
  page["residuals"] = ResidualsJson(scene, content, index);
  const auto num_used =
      std::count_if(content.pairs.begin(), content.pairs.end(),
                    [](const ReportPair& pair) { return pair.is_used; });
  const auto num_meaningful =
      std::count_if(scene.scale_ratios.begin(), scene.scale_ratios.end(),
                    [](const ScaleRatio& ratio) {
                      return ratio.verdict == RatioVerdict::kMeaningful;
                    });
  page["thinning"] = {{"point_stride", index.point_stride},
                      {"feature_stride", index.feature_stride},
                      {"num_points", scene.structure.size()},
                      {"num_pairs", content.pairs.size()},
                      {"num_used_pairs", num_used},
                      {"num_triplets", scene.scale_ratios.size()},
                      {"num_meaningful", num_meaningful}};
  // File names need not be UTF-8.
  return WithoutMarkup(
      page.dump(-1, ' ', true, PageJson::error_handler_t::replace));
}

}  // namespace lowlap
