#include "lowlap/io/internal/json/scene_json.h"

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/json/json_tree.h"
#include "lowlap/io/internal/json/json_value.h"
#include "lowlap/io/internal/json/scene_json_sections.h"
#include "lowlap/scene/validation.h"

namespace lowlap {

Result<Scene> ParseSceneJson(const std::string& text, const std::string& file) {
  return CaughtScene(
      [&] {
        const Result<JsonTree> tree = ParseJson(text);
        if (!tree) throw Failure{tree.error()};
        const JsonValue root(*tree, 0);
        Scene scene = ReadOpenMvgSections(root);
        if (const auto own = root.Find("lowlap")) ReadOwnSections(*own, scene);
        return scene;
      },
      file);
}

Result<Scene> ReadSceneJson(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
  return ParseSceneJson(text, path);
}

Result<std::string> FormatSceneJson(const Scene& scene) {
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  std::string text = "{\n";
  AppendOpenMvgSections(scene, text);
  text += ",\n\"lowlap\": {\n";
  AppendOwnSections(scene, text);
  text += "\n}\n}\n";
  return text;
}

}  // namespace lowlap
