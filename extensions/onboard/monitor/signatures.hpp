#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "extensions/onboard/monitor/motion_window.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// The equations of one window: measured less predicted, and what causes would change in it.
struct WindowEquations {
  Eigen::VectorXd residual{};    ///< A, one row per motor; or W, one row, where only the battery is measured
  Eigen::VectorXd per_kg{};      ///< of payload
  Eigen::VectorXd resistance{};  ///< the nominal dry friction of both wheels
  Eigen::MatrixXd other{};       ///< one column per other cause, of its typical size
  bool driving{};                ///< the motion gains kinetic energy
};

/// Predicts windows with the model, and with each cause of the effect catalog that resists the motion or
/// belongs to the floor: they may change on a day without any change of payload. Shapes are the typical ones;
/// causes with a region or a memory are left out.
class Signatures {
 public:
  explicit Signatures(const Robot& robot);

  [[nodiscard]] std::optional<WindowEquations> equations(const WindowMean& window, double payload_kg) const;
  const std::vector<std::string>& names() const { return names_; }
  const Robot& robot() const { return base_.robot; }

 private:
  [[nodiscard]] Eigen::VectorXd predicted(const Plant& plant, const WindowMean& window,
                                          double payload_kg) const;
  void add(const Robot& robot, const EffectSetting& setting);

  Plant base_;
  Plant resisted_;  ///< with twice the dry friction
  std::vector<Plant> changed_{};
  std::vector<std::string> names_{};
};

}  // namespace joulepath
