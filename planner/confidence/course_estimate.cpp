#include "planner/confidence/course_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr Eigen::Index kOfPlan = 2, kOfLeg = 3;  ///< numbers
constexpr double kSmallRise = 0.05;              ///< to which a change is relative at least

}  // namespace

Eigen::VectorXd CourseEstimate::numbers_of(const PlanCourse& course) {
  Eigen::VectorXd numbers(kOfPlan + kOfLeg * std::ssize(course.legs));
  Eigen::Index at = 0;
  numbers[at++] = course.least_fraction;
  numbers[at++] = course.winding_use;
  for (const LegCourse& leg : course.legs) {
    numbers[at++] = leg.least_fraction;
    for (const Side side : kSides) numbers[at++] = leg.resistance_factor[side];
  }
  return numbers;
}

/// A winding is not colder than its surroundings.
PlanCourse CourseEstimate::course_of(const Eigen::VectorXd& numbers) {
  Eigen::Index at = 0;
  PlanCourse course;
  course.least_fraction = numbers[at++];
  course.winding_use = std::max(0.0, numbers[at++]);
  while (at < numbers.size()) {
    LegCourse& leg = course.legs.emplace_back();
    leg.least_fraction = numbers[at++];
    for (const Side side : kSides) leg.resistance_factor[side] = std::max(1.0, numbers[at++]);
  }
  return course;
}

CourseEstimate::CourseEstimate(const PlanCourse& nominal, const ErrorPlants& errors, double start_fraction,
                               bool sags)
    : start_fraction_(start_fraction),
      sags_(sags),
      nominal_(numbers_of(nominal)),
      slope_(Eigen::MatrixXd::Zero(nominal_.size(), std::ssize(errors.near))),
      curvature_(slope_),
      fall_per_sigma_(std::ssize(errors.near), 2) {
  for (std::size_t i = 0; i < errors.near.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd more = numbers_of(errors.near[i][0].course) - nominal_,
                          less = numbers_of(errors.near[i][1].course) - nominal_;
    slope_.col(at) = 0.5 * (more - less);
    if (i + errors.one_sided < errors.near.size()) curvature_.col(at) = more + less;
    for (const std::size_t side : {0, 1}) {
      const PlanCourse &near = errors.near[i][side].course, &far = errors.far[i][side].course;
      const auto column = static_cast<Eigen::Index>(side);
      fall_per_sigma_(at, column) = std::max({0.0, nominal.least_fraction - near.least_fraction,
                                              (nominal.least_fraction - far.least_fraction) / kReach});
    }
  }
}

std::vector<PlanCourse> CourseEstimate::at(const Eigen::MatrixXd& errors) const {
  const Eigen::MatrixXd numbers =
      (slope_ * errors + 0.5 * curvature_ * errors.cwiseAbs2()).colwise() + nominal_;
  std::vector<PlanCourse> courses;
  for (const auto& column : numbers.colwise()) courses.push_back(course_of(column));
  return courses;
}

double CourseEstimate::together(Eigen::Index number, double base, const Eigen::VectorXd& errors) const {
  double product = 1, sum = 0;
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    const double x = std::abs(errors[i]);
    const double change =
        x * (std::abs(slope_(number, i)) + 0.5 * x * std::abs(curvature_(number, i))) / base;
    product *= 1 + change, sum += change;
  }
  return base * (product - 1 - sum);
}

bool CourseEstimate::is_in_doubt(double reserve_fraction, const Eigen::VectorXd& errors,
                                 const PlanCourse& estimated) const {
  constexpr double kTogether = 1.5;      // of what each error does alone: errors act together
  constexpr double kRough = 0.01;        // of an estimate's use
  constexpr double kSameCharge = 0.003;  // of an estimate on which voltages depend
  const double fall = kTogether * (fall_per_sigma_.col(0).dot(errors.cwiseMax(0.0)) -
                                   fall_per_sigma_.col(1).dot(errors.cwiseMin(0.0)));
  const double drained = std::max(start_fraction_ - nominal_[0], kSmallRise);
  const double doubt = kRough + together(1, std::max(nominal_[1], kSmallRise), errors);
  return !(nominal_[0] - fall >= reserve_fraction) || !(std::abs(estimated.winding_use - 1) > doubt) ||
         (sags_ && !(together(0, drained, errors) < kSameCharge));
}

}  // namespace joulepath
