#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <tuple>

#include "lowlap/core/ids.h"

// Ids are numbers in Python; pairs and triplets of views are tuples of them.
namespace pybind11::detail {

template <class Thing>
struct type_caster<lowlap::Id<Thing>> {
  PYBIND11_TYPE_CASTER(lowlap::Id<Thing>, const_name("int"));

  bool load(handle source, bool convert) {
    make_caster<std::uint32_t> number;
    if (!number.load(source, convert)) return false;
    value = lowlap::Id<Thing>(cast_op<std::uint32_t>(number));
    return true;
  }
  static handle cast(lowlap::Id<Thing> id, return_value_policy, handle) {
    return PyLong_FromUnsignedLong(id.value());
  }
};

template <>
struct type_caster<lowlap::ViewPair> {
  PYBIND11_TYPE_CASTER(lowlap::ViewPair, const_name("Tuple[int, int]"));
  using Ids = std::tuple<lowlap::ViewId, lowlap::ViewId>;

  bool load(handle source, bool convert) {
    make_caster<Ids> ids;
    if (!ids.load(source, convert)) return false;
    std::tie(value.first, value.second) = cast_op<Ids>(ids);
    return true;
  }
  static handle cast(const lowlap::ViewPair& pair, return_value_policy policy,
                     handle parent) {
    return make_caster<Ids>::cast(Ids(pair.first, pair.second), policy, parent);
  }
};

template <>
struct type_caster<lowlap::ViewTriplet> {
  PYBIND11_TYPE_CASTER(lowlap::ViewTriplet, const_name("Tuple[int, int, int]"));
  using Ids = std::tuple<lowlap::ViewId, lowlap::ViewId, lowlap::ViewId>;

  bool load(handle source, bool convert) {
    make_caster<Ids> ids;
    if (!ids.load(source, convert)) return false;
    std::tie(value.first, value.middle, value.last) = cast_op<Ids>(ids);
    return true;
  }
  static handle cast(const lowlap::ViewTriplet& triplet,
                     return_value_policy policy, handle parent) {
    return make_caster<Ids>::cast(
        Ids(triplet.first, triplet.middle, triplet.last), policy, parent);
  }
};

}  // namespace pybind11::detail
