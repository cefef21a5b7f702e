#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A way to keep a scene on disk. A path is a file or a folder, as the format
/// likes. Implementations have no state and may be used by several threads.
class SceneFormat {
 public:
  virtual ~SceneFormat() = default;

  /// A short word to select the format by ("lowlap", "openmvg-json", ...).
  virtual std::string Name() const = 0;
  /// One line for a person.
  virtual std::string Description() const = 0;
  /// Whether the path looks like this format. The path need not exist: it may
  /// be one to write to.
  virtual bool Recognizes(const std::string& path) const = 0;
  virtual Result<Scene> Read(const std::string& path) const = 0;
  virtual bool CanWrite() const = 0;
  /// kUnsupported where CanWrite() is false.
  virtual Status Write(const Scene& scene, const std::string& path) const;
};

using SceneFormats = std::vector<std::unique_ptr<const SceneFormat>>;

/// The formats of this folder: "json" (*.json) and "lowlap" (*.lowlap).
SceneFormats OwnSceneFormats();

/// The first format that recognises the path, or kUnsupported with the list of
/// those that exist. The pointer belongs to `formats`.
Result<const SceneFormat*> FindSceneFormat(const SceneFormats& formats,
                                           const std::string& path);

}  // namespace lowlap
