#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Views by what people call them. A word is looked up, in this order, as
///   the path below the image folder ("cameras/left/0001.jpg"),
///   the file name, as the scene has it ("left/0001.jpg"),
///   its last part ("0001.jpg"), or that without extension ("0001"),
///   the id of a view.
/// The first of these that any view fits decides; if several views fit, the
/// word is ambiguous and refused. Where the names of all views are numbers, a
/// number is always a name ("1" is "0001.jpg"), never an id: ids are places in
/// a list, which shift as soon as a photograph is left out.
class ViewNames {
 public:
  explicit ViewNames(const Scene& scene);

  /// kInvalidArgument: no view, or several, which are named.
  Result<ViewId> Find(const std::string& word) const;

 private:
  using Index = std::map<std::string, std::vector<ViewId>>;

  std::map<ViewId, std::string> whole_names_;
  std::vector<Index> indices_;  // in the order of precedence
};

}  // namespace lowlap
