#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "python/bindings.h"

namespace lowlap::python {

/// A read-only array on memory of `owner`, which lives as long as the array:
/// nothing is copied. Solved and unsolved scenes alike are never changed once
/// Python has them, so that the memory stays where it is.
template <class T>
py::array ArrayOn(const T* data, std::vector<py::ssize_t> shape,
                  std::vector<py::ssize_t> strides, py::handle owner) {
  py::array array(py::dtype::of<T>(), std::move(shape), std::move(strides),
                  data, owner);
  py::detail::array_proxy(array.ptr())->flags &=
      ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// The same for a member of every element of a vector: n x `columns` numbers
/// that follow on `first`, the first element's member; null if there are none.
/// With 0 columns: n numbers.
template <class Element, class T>
py::array MemberArray(const std::vector<Element>& elements, const T* first,
                      std::size_t columns, py::handle owner) {
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(elements.size())};
  std::vector<py::ssize_t> strides = {sizeof(Element)};
  if (columns > 0) {
    shape.push_back(static_cast<py::ssize_t>(columns));
    strides.push_back(sizeof(T));
  }
  return ArrayOn(first, std::move(shape), std::move(strides), owner);
}

/// Elements that are so many unsigned numbers of 32 bits, as ids are.
template <class Element>
py::array IndexArray(const std::vector<Element>& elements, py::handle owner) {
  constexpr std::size_t kColumns = sizeof(Element) / sizeof(std::uint32_t);
  static_assert(sizeof(Element) % sizeof(std::uint32_t) == 0 &&
                std::is_standard_layout_v<Element>);
  return MemberArray(elements,
                     reinterpret_cast<const std::uint32_t*>(elements.data()),
                     kColumns == 1 ? 0 : kColumns, owner);
}

}  // namespace lowlap::python
