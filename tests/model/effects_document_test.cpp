#include "model/effects/effects_document.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "model/effects/catalog.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

TEST(EffectsReference, TheCommittedDocumentIsTheCatalogs) {
  std::ifstream file(JOULEPATH_SOURCE_DIR "/docs/effects.md");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), effects_markdown()) << "run: joulepath effects --markdown > docs/effects.md";
}

TEST(EffectsReference, EveryEffectSaysItsLawAndCounterparts) {
  for (const EffectDescription& effect : effect_catalog()) {
    EXPECT_FALSE(effect.info.law.empty()) << effect.info.name;
    EXPECT_FALSE(effect.info.validity.empty()) << effect.info.name;
    EXPECT_FALSE(effect.info.gazebo.empty()) << effect.info.name;
    EXPECT_FALSE(effect.info.mujoco.empty()) << effect.info.name;
    for (const ParameterDescription& p : effect.parameters) {
      EXPECT_LT(p.min, p.max) << effect.info.name;
      EXPECT_GE(p.typical, p.min) << effect.info.name;
      EXPECT_LE(p.typical, p.max) << effect.info.name;
    }
  }
}

}  // namespace
}  // namespace joulepath
