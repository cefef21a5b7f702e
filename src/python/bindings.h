#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/id_casters.h"

namespace lowlap::python {

namespace py = pybind11;

// Each adds one subject to the module.
void BindScene(py::module_& module);
void BindRatios(py::module_& module);
void BindAveraging(py::module_& module);
void BindEvaluation(py::module_& module);
void BindSolve(py::module_& module);
void BindMerge(py::module_& module);
void BindDiagnosis(py::module_& module);
void BindCompare(py::module_& module);
void BindHost(py::module_& module);
void BindSimulation(py::module_& module);

}  // namespace lowlap::python
