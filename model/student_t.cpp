#include "model/student_t.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>

namespace joulepath {

double student_t_975(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t(std::max(1.0, degrees_of_freedom)), 0.975);
}

}  // namespace joulepath
