#include "lowlap/report/internal/report.h"

#include <string_view>

#include "lowlap/report/internal/markup.h"
#include "lowlap/report/internal/page_data.h"
#include "lowlap/report/internal/page_source.h"

namespace lowlap {
namespace {

std::string ContentOf(std::string_view name, const Scene& scene,
                      const ReportContent& content) {
  if (name == "TITLE") return EscapeMarkup(content.title);
  if (name == "DATA") return PageData(scene, content);
  if (name == "STYLE") return std::string(kPageSource.style);
  if (name == "THREE") return std::string(kPageSource.three);
  return std::string(kPageSource.script);
}

}  // namespace

std::string FormatReport(const Scene& scene, const ReportContent& content) {
  std::string page;
  std::string_view html = kPageSource.html;
  // @NAME@ in the template stands for a part; nothing else in it has an @.
  for (std::size_t at; (at = html.find('@')) != std::string_view::npos;) {
    const std::size_t end = html.find('@', at + 1);
    page += html.substr(0, at);
    page += ContentOf(html.substr(at + 1, end - at - 1), scene, content);
    html.remove_prefix(end + 1);
  }
  page += html;
  return page;
}

}  // namespace lowlap
