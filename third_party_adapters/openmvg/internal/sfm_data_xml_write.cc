#include <cstdio>
#include <nlohmann/json.hpp>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "third_party_adapters/openmvg/internal/sfm_data_xml.h"

namespace lowlap::openmvg {
namespace {

using Json = nlohmann::ordered_json;

/// Whether XML 1.0 has every character of the text (which is UTF-8).
bool FitsIntoXml(const std::string& text) {
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' &&
        c != '\r') {
      return false;
    }
  }
  return text.find("\xEF\xBF\xBE") == std::string::npos &&
         text.find("\xEF\xBF\xBF") == std::string::npos;
}

/// One element; `name` is its tag. False if a text does not fit into XML.
bool AppendElement(const std::string& name, const Json& value, int level,
                   std::string& xml) {
  const std::string indent(static_cast<std::size_t>(level), '\t');
  xml += indent + "<" + name;
  if (value.is_array()) xml += " size=\"dynamic\"";
  if (value.is_structured()) {
    if (value.empty()) {
      xml += "/>\n";
      return true;
    }
    xml += ">\n";
    int index = 0;
    for (const auto& [key, child] : value.items()) {
      const std::string child_name =
          value.is_array() ? "value" + std::to_string(index++) : key;
      if (!AppendElement(child_name, child, level + 1, xml)) return false;
    }
    xml += indent + "</" + name + ">\n";
    return true;
  }
  if (value.is_string()) {
    const std::string& text = value.get_ref<const std::string&>();
    if (!FitsIntoXml(text)) return false;
    const auto is_space = [](char c) {
      return c == ' ' || c == '\t' || c == '\n' || c == '\r';
    };
    if (!text.empty() && (is_space(text.front()) || is_space(text.back()))) {
      xml += " xml:space=\"preserve\"";
    }
    xml += '>';
    for (const char c : text) {
      switch (c) {
        case '&':
          xml += "&amp;";
          break;
        case '<':
          xml += "&lt;";
          break;
        case '>':
          xml += "&gt;";
          break;
        case '"':
          xml += "&quot;";
          break;
        case '\'':
          xml += "&apos;";
          break;
        case '\r':  // readers turn a plain one into a line feed
          xml += "&#13;";
          break;
        default:
          xml += c;
      }
    }
  } else if (value.is_number_float()) {
    char digits[32];
    std::snprintf(digits, sizeof(digits), "%.17g", value.get<double>());
    xml += '>';
    xml += digits;
  } else {
    xml += '>' + value.dump();
  }
  xml += "</" + name + ">\n";
  return true;
}

}  // namespace

Result<std::string> FormatSfmDataXml(const Scene& scene) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string text, FormatSceneJson(scene));
  Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) {
    return MakeError(ErrorCode::kInvalidScene, "the scene has no text form");
  }
  json.erase("lowlap");
  std::string xml = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";
  if (!AppendElement("cereal", json, 0, xml)) {
    return MakeError(ErrorCode::kInvalidScene,
                     "a path or file name holds a character that XML cannot "
                     "hold");
  }
  xml += '\n';
  return xml;
}

}  // namespace lowlap::openmvg
