#include "lowlap/scene/scene.h"

#include <filesystem>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "lowlap/pipeline/image_collection.h"
#include "lowlap/scene/validation.h"
#include "python/arrays.h"
#include "python/call.h"
#include "python/keywords.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::python {
namespace {

// A map of the scene as a mapping of Python, which looks it up where it is.
template <class Map>
struct MapOf {
  const Map* map;
};

template <class Value>
py::object ElementOf(const Value& value, const py::object& map) {
  if constexpr (std::is_same_v<Value, Track>) {
    return IndexArray(value, map);
  } else {
    return py::cast(value, py::return_value_policy::reference_internal, map);
  }
}

// A list of what `make` makes of every entry.
template <class Map, class Make>
py::list ListOf(const Map& map, const Make& make) {
  py::list list;
  for (const auto& entry : map) list.append(make(entry));
  return list;
}

template <class Map>
void BindMap(py::module_& module, const char* name) {
  using Key = typename Map::key_type;
  const auto map_of = [](const py::object& self) -> const Map& {
    return *self.cast<const MapOf<Map>&>().map;
  };
  // Empty if it is not there, as whatever is no id: an intrinsic_id of None.
  const auto find = [map_of](const py::object& self, const py::object& key) {
    py::detail::make_caster<Key> id;
    if (!id.load(key, true)) return py::object();
    const auto found = map_of(self).find(py::detail::cast_op<Key>(id));
    return found == map_of(self).end() ? py::object()
                                       : ElementOf(found->second, self);
  };
  py::class_<MapOf<Map>> bound(module, name, "A read-only mapping, by id.");
  bound.def("__len__", [](const MapOf<Map>& self) { return self.map->size(); })
      .def("__contains__",
           [find](const py::object& self, const py::object& key) {
             return static_cast<bool>(find(self, key));
           })
      .def("__getitem__",
           [find](const py::object& self, const py::object& key) {
             const py::object found = find(self, key);
             if (!found) {
               throw py::key_error(py::repr(key).template cast<std::string>());
             }
             return found;
           })
      .def(
          "get",
          [find](const py::object& self, const py::object& key,
                 const py::object& otherwise) {
            const py::object found = find(self, key);
            return found ? found : otherwise;
          },
          py::arg("key"), py::arg("default") = py::none())
      .def("__iter__",
           [map_of](const py::object& self) {
             return py::iter(ListOf(map_of(self), [](auto& entry) {
               return py::cast(entry.first);
             }));
           })
      .def("keys",
           [map_of](const py::object& self) {
             return ListOf(map_of(self),
                           [](auto& entry) { return py::cast(entry.first); });
           })
      .def("values",
           [map_of](const py::object& self) {
             return ListOf(map_of(self), [&](auto& entry) {
               return ElementOf(entry.second, self);
             });
           })
      .def("items", [map_of](const py::object& self) {
        return ListOf(map_of(self), [&](auto& entry) {
          return py::make_tuple(entry.first, ElementOf(entry.second, self));
        });
      });
  py::module_::import("collections.abc")
      .attr("Mapping")
      .attr("register")(bound);
}

// A property of Scene that is one of its maps.
template <class Map>
auto MapMember(const Map Scene::*member) {
  return py::cpp_function(
      [member](const Scene& scene) { return MapOf<Map>{&(scene.*member)}; },
      py::keep_alive<0, 1>());
}

std::shared_ptr<const Scene> ReadWithout(
    const py::object& path, const std::vector<std::string>& exclude,
    py::object log) {
  Call call(py::none(), std::move(log), 0, 0);
  const auto scene = SceneOf(path, &call);
  if (exclude.empty()) return scene;
  return std::make_shared<Scene>(
      WithoutViews(*scene, ValueOf(FindViews(*scene, exclude))));
}

std::shared_ptr<const Scene> Measure(const py::object& path,
                                     const py::kwargs& kwargs) {
  Keywords keywords("measure", kwargs);
  const auto call = TakeCall(&keywords);
  const SceneInput input = TakeSceneInput(&keywords);
  keywords.Finish();
  return MeasuredSceneOf(path, input, call.get()).scene;
}

std::string DescribeScene(const Scene& scene) {
  return "<lowlap.Scene: " + std::to_string(scene.views.size()) + " views, " +
         std::to_string(scene.relative_poses.size()) + " relative poses, " +
         std::to_string(scene.scale_ratios.size()) + " scale ratios, " +
         std::to_string(scene.poses.size()) + " poses, " +
         std::to_string(scene.structure.size()) + " points, " +
         std::to_string(scene.line_structure.size()) + " lines>";
}

}  // namespace

void BindSceneParts(py::module_& module);

void BindScene(py::module_& module) {
  BindSceneParts(module);
  BindMap<decltype(Scene::views)>(module, "ViewMap");
  BindMap<decltype(Scene::intrinsics)>(module, "IntrinsicMap");
  BindMap<decltype(Scene::poses)>(module, "PoseMap");
  BindMap<decltype(Scene::features)>(module, "FeaturesMap");
  BindMap<decltype(Scene::relative_poses)>(module, "RelativePoseMap");
  BindMap<decltype(Scene::point_tracks)>(module, "PointTrackMap");
  BindMap<decltype(Scene::line_tracks)>(module, "LineTrackMap");
  BindMap<decltype(Scene::structure)>(module, "LandmarkMap");
  BindMap<decltype(Scene::line_structure)>(module, "LineLandmarkMap");

  py::class_<Scene, std::shared_ptr<Scene>>(
      module, "Scene",
      "What is measured (views, intrinsics, features, relative poses, tracks)\n"
      "and what is solved (ratios, poses, structure). Never changes: solve()\n"
      "returns another one. Arrays are views of its memory and keep it alive.")
      .def_readonly("root_path", &Scene::root_path)
      .def_property_readonly("views", MapMember(&Scene::views))
      .def_property_readonly("intrinsics", MapMember(&Scene::intrinsics))
      .def_property_readonly(
          "given_intrinsics", MapMember(&Scene::given_intrinsics),
          "Of the intrinsics that an adjustment moved: as they were given.")
      .def_property_readonly("poses", MapMember(&Scene::poses),
                             "Solved poses, by View.pose_id.")
      .def_property_readonly("features", MapMember(&Scene::features))
      .def_property_readonly("relative_poses",
                             MapMember(&Scene::relative_poses),
                             "By (first, second), first < second.")
      .def_property_readonly(
          "unrelated_pairs",
          [](const py::object& self) {
            return IndexArray(self.cast<const Scene&>().unrelated_pairs, self);
          },
          "(n, 2): views that were compared in vain, without a relative pose.")
      .def_property_readonly("point_tracks", MapMember(&Scene::point_tracks),
                             "(n, 2) arrays: view, index of the point.")
      .def_property_readonly("line_tracks", MapMember(&Scene::line_tracks),
                             "(n, 2) arrays: view, index of the segment.")
      .def_property_readonly("structure", MapMember(&Scene::structure))
      .def_property_readonly("line_structure",
                             MapMember(&Scene::line_structure))
      .def_property_readonly(
          "scale_ratios",
          [](const py::object& self) {
            return ListOf(self.cast<const Scene&>().scale_ratios,
                          [&](auto& ratio) { return ElementOf(ratio, self); });
          })
      .def_property_readonly(
          "coplanar_pairs",
          [](const py::object& self) {
            return IndexArray(self.cast<const Scene&>().coplanar_pairs, self);
          },
          "(n, 2): ids of lines in line_structure that lie in one plane.")
      .def("find_pose", &Scene::FindPose, py::arg("view"),
           py::return_value_policy::reference_internal,
           "The solved pose of a view, or None.")
      .def("find_intrinsic", &Scene::FindIntrinsic, py::arg("view"),
           py::return_value_policy::reference_internal,
           "The intrinsic of a view, or None.")
      .def(
          "image_path",
          [](const Scene& scene, ViewId view) {
            if (scene.views.count(view) == 0) {
              throw py::key_error(std::to_string(view.value()));
            }
            return scene.ImagePath(view);
          },
          py::arg("view"))
      .def(
          "validate",
          [](const Scene& scene) { RaiseIfError(ValidateScene(scene)); },
          "Raises Error, with the place, if the scene contradicts itself.")
      .def("without_views", &WithoutViews, py::arg("views"),
           "A copy without these views and all that refers to them.")
      .def(
          "write",
          [](const Scene& scene, const std::filesystem::path& path,
             const std::string& format) {
            return ValueOf(WriteScene(scene, path.string(), format));
          },
          py::arg("path"), py::arg("format") = "",
          "Writes the scene in the format of the extension, or in the named\n"
          "one. Returns notes on what the format cannot hold.")
      .def(
          "__eq__", [](const Scene& a, const Scene& b) { return a == b; },
          py::is_operator())
      .def("__repr__", &DescribeScene)
      .attr("__hash__") = py::none();

  module.def("read", &ReadWithout, py::arg("path"),
             py::arg("exclude") = std::vector<std::string>(),
             py::arg("log") = py::none(),
             "Reads a scene file or folder of any format, without the views\n"
             "named in `exclude`. What the reader leaves out goes to\n"
             "log(level, message), or is a warning.");
  module.def(
      "measure", &Measure, py::arg("path"),
      "A scene with relative poses: those of a scene file, or estimated from\n"
      "the matches of a COLMAP database, or of an OpenMVG listing with\n"
      "`matchdir`, the folder of its .feat and matches.* files.\n\n"
      "Options: matchdir; match_file, one in that folder; images, the\n"
      "photographs of a database or a listing, for lines; exclude, views to\n"
      "leave out; threads, seed, progress, log.");
}

}  // namespace lowlap::python
