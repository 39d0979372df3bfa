#pragma once

#include <vector>

#include "planner/joint/bordered_system.hpp"
#include "planner/joint/interior_rows.hpp"
#include "planner/joint/speed_parts.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
namespace joulepath::joint {

/// Limits of the motors and the battery at both ends of the speed's parts. A row joins the program when the
/// path comes near its limit: on most floors none does.
class MotorRows {
 public:
  MotorRows(const Program& program, const std::vector<SpeedPart>& parts) : program_(program), parts_(parts) {}

  std::size_t size() const { return rows_.size(); }
  /// Takes in the limits that are nearly used.
  void join(const Eigen::VectorXd& squares, const Eigen::VectorXd& parameters, double mu);

  struct Sums {
    double complementarity{}, primal{};
  };
  Sums assemble(const Eigen::VectorXd& squares, const Eigen::VectorXd& parameters, double mu,
                BorderedSystem& system);
  void step(const UnknownVector& step, double mu, StepLengths& lengths);
  /// Unused shares of the limits, by rows.
  [[nodiscard]] std::vector<double> values(const Eigen::VectorXd& squares,
                                           const Eigen::VectorXd& parameters) const;
  [[nodiscard]] std::vector<double> present() const;
  double merit(const std::vector<double>& values, double step, double mu, double weight) const;
  void take(const std::vector<double>& values, double primal, double dual, double mu);

 private:
  struct At {
    std::size_t part{}, end{};
    std::size_t limit{};  ///< of the law's wheel limits, then of its power limits
    double sign{1};       ///< of what is limited
    bool operator==(const At&) const = default;
  };
  struct MotorRow {
    At at{};
    Row row{};
    nlp::JetOf<kSegmentVariables> value{};
  };
  const DriveLaw& law(std::size_t part) const {
    return program_.laws[program_.pieces[parts_[part].piece].law];
  }
  template <class Real>
  Real unused(const At& at, const Eigen::VectorXd& squares, const Eigen::VectorXd& parameters) const;

  const Program& program_;
  const std::vector<SpeedPart>& parts_;
  std::vector<MotorRow> rows_{};
};

}  // namespace joulepath::joint
