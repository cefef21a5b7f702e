#include "third_party_adapters/openmvg/internal/xml_structure.h"

#include <algorithm>
#include <cstddef>

namespace lowlap::openmvg {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

class Scanner {
 public:
  Scanner(std::string_view text, int max_depth)
      : text_(text), max_depth_(max_depth) {}

  /// Null, or what is wrong; offset() tells where.
  const char* Scan() {
    if (const std::size_t nul = text_.find('\0'); nul != text_.npos) {
      at_ = nul;
      return "not XML: a null byte";
    }
    int depth = 0;
    while ((at_ = text_.find('<', at_)) != text_.npos) {
      const char* failure = nullptr;
      if (Take("<!--")) {
        failure = SkipPast("-->");
      } else if (Take("<![CDATA[")) {
        failure = SkipPast("]]>");
      } else if (Take("<?")) {
        failure = SkipPast("?>");
      } else if (Take("<!")) {
        failure = SkipDeclaration();
      } else if (Take("</")) {
        if (--depth < 0) return "not XML: an end tag without a start tag";
        failure = SkipPast(">");
      } else {
        bool is_empty = false;
        failure = SkipStartTag(&is_empty);
        if (!is_empty && ++depth > max_depth_) {
          return "the elements are nested too deeply";
        }
      }
      if (failure != nullptr) return failure;
    }
    return nullptr;
  }
  std::size_t offset() const { return at_; }

 private:
  bool Take(std::string_view token) {
    if (text_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }
  const char* SkipPast(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == text_.npos) return "not XML: the text ends within a tag";
    at_ = found + end.size();
    return nullptr;
  }
  void SkipSpace() {
    at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size());
  }
  bool TakeName() {
    const std::size_t start = at_;
    at_ = std::min(text_.find_first_of(" \t\r\n/<>=?!&\"'", at_), text_.size());
    return at_ > start;
  }
  /// <!DOCTYPE name> and the like, without inner brackets.
  const char* SkipDeclaration() {
    const std::size_t end = text_.find_first_of("[>", at_);
    if (end == text_.npos || text_[end] == '[') {
      return "not XML: a declaration that is not understood";
    }
    at_ = end + 1;
    return nullptr;
  }
  const char* SkipStartTag(bool* is_empty) {
    ++at_;  // <
    if (!TakeName()) return "not XML: an element without a name";
    for (SkipSpace(); at_ < text_.size(); SkipSpace()) {
      if (Take(">")) return nullptr;
      if ((*is_empty = Take("/>"))) return nullptr;
      if (!TakeName()) break;
      SkipSpace();
      if (!Take("=")) break;
      SkipSpace();
      const std::string_view quote = text_.substr(at_, 1);
      if (!Take("\"") && !Take("'")) break;
      if (const char* failure = SkipPast(quote)) return failure;
    }
    return "not XML: a malformed tag";
  }

  std::string_view text_;
  int max_depth_;
  std::size_t at_ = 0;
};

}  // namespace

Status CheckXmlStructure(std::string_view text, int max_depth,
                         const std::string& file) {
  Scanner scanner(text, max_depth);
  const char* failure = scanner.Scan();
  if (failure == nullptr) return {};
  return MakeError(ErrorCode::kParse, failure, file,
                   "byte " + std::to_string(scanner.offset()));
}

}  // namespace lowlap::openmvg
