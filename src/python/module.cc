#include "python/bindings.h"

PYBIND11_MODULE(_lowlap, module) {
  using namespace lowlap::python;
  module.doc() = "The compiled part of lowlap.";
  module.attr("__version__") = LOWLAP_VERSION;
  BindScene(module);
  BindRatios(module);
  BindEvaluation(module);
  BindAveraging(module);
  BindSolve(module);
  BindMerge(module);
  BindDiagnosis(module);
  BindCompare(module);
  BindHost(module);
  BindSimulation(module);
}
