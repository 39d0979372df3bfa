// What an extension registers is what its file `adds` says, in both directions.
#include "scenarios/registry.hpp"

#include <gtest/gtest.h>

#include <set>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/program_parts.hpp"

namespace joulepath {
namespace {

using Words = std::set<std::string>;

Words declared(std::string_view part) {
  Words words;
  for (const Addition& addition : known_additions())
    if (addition.is_built && addition.part == part) words.insert(std::string(addition.name));
  return words;
}

template <class List, class Name>
Words names_of(const List& list, Name name) {
  Words words;
  for (const auto& item : list) words.insert(name(item));
  return words;
}

TEST(Extensions, CommandsAreDeclared) {
  EXPECT_EQ(
      names_of(extension_parts().commands, [](const auto& command) { return command.make()->text().name; }),
      declared("command"));
}

TEST(Extensions, ExportsAreDeclared) {
  Words names = names_of(registry().exports, [](const auto& format) { return format.name; });
  names.merge(names_of(extension_parts().export_tasks, [](const auto make) { return make()->name(); }));
  EXPECT_EQ(names, declared("export"));
}

TEST(Extensions, KindsOfFilesAreDeclared) {
  Words names = names_of(registry().kinds, [](const auto& kind) { return kind.name; });
  names.merge(names_of(registry().files, [](const auto& reader) { return reader.kind; }));
  EXPECT_EQ(names, declared("kind"));
}

TEST(Extensions, KeysOfMissionsAreDeclared) {
  for (const MissionKey& known : registry().mission_keys)
    EXPECT_TRUE(declared("key").contains(known.key)) << known.key;
}

TEST(Extensions, OptionsAreDeclared) {
  Words flags;
  for (const CommandSummary& command : summaries(all_commands()))
    for (const std::string& flag : command.flags) flags.insert(command.name + " " + flag);
  for (const std::string& option : declared("option")) EXPECT_TRUE(flags.contains(option)) << option;
}

TEST(Extensions, TheCoresCommandsComeFirst) {
  bool extensions_began = false;
  for (const auto& command : all_commands()) {
    extensions_began = extensions_began || !command->extension().empty();
    EXPECT_EQ(extensions_began, !command->extension().empty()) << command->text().name;
  }
}

TEST(Extensions, WhatIsBuiltIsNotRefused) {
  for (const Addition& addition : known_additions())
    EXPECT_EQ(absent_extension(addition.part, addition.name).empty(), addition.is_built) << addition.name;
}

}  // namespace
}  // namespace joulepath
