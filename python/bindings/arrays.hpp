#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>
#include <vector>

#include "model/trajectory.hpp"

namespace joulepath::python {

namespace nb = nanobind;

/// Numbers from Python; the package converts them to contiguous, finite float64.
using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Points = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Caps = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;  ///< from, to, speed

[[nodiscard]] std::vector<double> vector_of(const Numbers& numbers);

/// A read-only numpy view of values that `owner` keeps alive.
[[nodiscard]] nb::ndarray<nb::numpy, const double, nb::ndim<1>> view_of(const std::vector<double>& values,
                                                                        nb::handle owner);

/// A trajectory owned by Python. It never changes, because its channels are exposed as views.
struct Log {
  Trajectory trajectory{};
};

}  // namespace joulepath::python
