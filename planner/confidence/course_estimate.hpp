#pragma once

#include "planner/confidence/plan_course.hpp"

namespace joulepath {

/// The courses of drawn plants to second order in each of their errors, from the plants of one sigma.
class CourseEstimate {
 public:
  /// `errors`: with the courses of its plants. `sags`: voltages depend on the charge.
  CourseEstimate(const PlanCourse& nominal, const ErrorPlants& errors, double start_fraction, bool sags);

  /// For each column of errors (PlantDraw).
  [[nodiscard]] std::vector<PlanCourse> at(const Eigen::MatrixXd& errors) const;

  /// Whether the estimated course of errors leaves a doubt about a reserve or the windings' limits: by what
  /// the largest error that is drawn does, and by what the errors do together.
  [[nodiscard]] bool is_in_doubt(double reserve_fraction, const Eigen::VectorXd& errors,
                                 const PlanCourse& estimated) const;

 private:
  /// A course as numbers: the least fraction, the winding's use, then three of each leg.
  static Eigen::VectorXd numbers_of(const PlanCourse& course);
  static PlanCourse course_of(const Eigen::VectorXd& numbers);
  /// By how much a number, of the size of a base, differs from the sum of what each error does alone.
  double together(Eigen::Index number, double base, const Eigen::VectorXd& errors) const;

  double start_fraction_{1.0};
  bool sags_{};
  Eigen::VectorXd nominal_{};
  Eigen::MatrixXd slope_{}, curvature_{};  ///< of each number (a row) for one sigma of each error
  Eigen::MatrixX2d fall_per_sigma_{};      ///< of the fraction at most, with more and less of each error
};

}  // namespace joulepath
