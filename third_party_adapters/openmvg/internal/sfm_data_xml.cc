#include "third_party_adapters/openmvg/internal/sfm_data_xml.h"

// The parser inside cereal needs cereal's macros before it.
#include <cereal/macros.hpp>
//
#include <cereal/external/rapidxml/rapidxml.hpp>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "third_party_adapters/openmvg/internal/xml_structure.h"

namespace lowlap::openmvg {
namespace {

namespace rapidxml = cereal::rapidxml;
using Json = nlohmann::ordered_json;

/// The items of sfm_data whose values are text, so that a file name like
/// "0010" does not become a number.
bool IsStringItem(const std::string& name) {
  static const std::set<std::string> kNames = {"sfm_data_version", "root_path",
                                               "local_path", "filename",
                                               "polymorphic_name"};
  return kNames.count(name) > 0;
}

/// Turns the elements of cereal's XML into the JSON of the same archive:
/// containers (size="dynamic") into arrays, elements with children into
/// objects, the rest into values.
class JsonFromXml {
 public:
  JsonFromXml(const char* buffer, std::string file)
      : buffer_(buffer), file_(std::move(file)) {}

  Status Append(const rapidxml::xml_node<>& node, std::string& json) {
    const std::string name(node.name(), node.name_size());
    const bool is_array = node.first_attribute("size") != nullptr;
    const rapidxml::xml_node<>* child = node.first_node();
    const bool has_elements =
        child != nullptr && child->type() == rapidxml::node_element;
    if (!is_array && !has_elements) return AppendValue(node, name, json);
    json += is_array ? '[' : '{';
    bool is_first = true;
    for (; child != nullptr; child = child->next_sibling()) {
      if (child->type() != rapidxml::node_element) continue;
      if (!is_first) json += ',';
      is_first = false;
      if (!is_array) {
        json += Json(std::string(child->name(), child->name_size())).dump();
        json += ':';
      }
      LOWLAP_RETURN_IF_ERROR(Append(*child, json));
    }
    json += is_array ? ']' : '}';
    return {};
  }

 private:
  Status AppendValue(const rapidxml::xml_node<>& node, const std::string& name,
                     std::string& json) {
    // With xml:space="preserve" cereal's parser leaves unexpanded text in the
    // element, except for blanks alone; the data below it is always right.
    const rapidxml::xml_node<>* data = node.first_node();
    const std::string value =
        data == nullptr ? std::string(node.value(), node.value_size())
                        : std::string(data->value(), data->value_size());
    if (IsStringItem(name)) {
      json += Json(value).dump();
      return {};
    }
    const bool is_scalar =
        !value.empty() && std::strchr("\"[{", value[0]) == nullptr;
    if (!is_scalar || !Json::accept(value)) {
      return MakeError(ErrorCode::kParse,
                       "<" + name + "> holds '" + value.substr(0, 32) +
                           "', not a finite number",
                       file_, "byte " + std::to_string(node.value() - buffer_));
    }
    json += value;
    return {};
  }

  const char* buffer_;
  std::string file_;
};

}  // namespace

Result<Scene> ParseSfmDataXml(const std::string& text,
                              const std::string& file) {
  constexpr int kMaxDepth = 64;  // OpenMVG's files have 10
  LOWLAP_RETURN_IF_ERROR(CheckXmlStructure(text, kMaxDepth, file));
  std::string buffer = text;  // the parser writes into it
  std::string json;
  try {
    rapidxml::xml_document<> document;
    document.parse<rapidxml::parse_validate_closing_tags>(buffer.data());
    const rapidxml::xml_node<>* root = document.first_node("cereal");
    if (root == nullptr) {
      return MakeError(ErrorCode::kParse, "the element <cereal> is missing",
                       file);
    }
    LOWLAP_RETURN_IF_ERROR(
        JsonFromXml(buffer.data(), file).Append(*root, json));
  } catch (const rapidxml::parse_error& error) {
    return MakeError(
        ErrorCode::kParse, std::string("not XML: ") + error.what(), file,
        "byte " + std::to_string(error.where<char>() - buffer.data()));
  } catch (const Json::exception&) {
    return MakeError(ErrorCode::kParse, "a text is not UTF-8", file);
  }
  return ParseSceneJson(json, file);
}

Result<Scene> ReadSfmDataXml(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
  return ParseSfmDataXml(text, path);
}

}  // namespace lowlap::openmvg
