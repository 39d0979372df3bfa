#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/text/schema.hpp"

namespace joulepath {

struct MessageChannel;
struct MessageDamage;
struct TimedMessage;
struct Export;
struct ExportInput;
struct FileSummary;
struct ForeignGraph;
struct Geometry;
struct LogTables;
struct MissionRequest;
struct MissionWorld;
struct RobotDraft;
struct Trajectory;
struct ColumnSource;
using ColumnSources = std::map<std::string, ColumnSource>;

/// Reads logs that are no CSV files.
struct LogReader {
  std::string says{};                        ///< "bag"
  bool (*reads)(const std::string& file){};  ///< whether this reader is the one of a file
  LogTables (*read)(const std::string& file, const NamedBy& named_by, const ColumnSources& sources,
                    const std::string& run){};
};

/// Reads files of messages over time that are no bags: states of a fleet's interface, for example.
struct MessageReader {
  bool (*reads)(const std::string& file){};
  MessageDamage (*read)(const std::string& file, const NamedBy& named_by,
                        const std::function<void(const MessageChannel&)>& on_channel,
                        const std::function<void(const TimedMessage&)>& on_message){};
  std::string_view type{};  ///< of its channels
  /// Columns of a run and the fields that may hold them; the first field that is there counts.
  std::vector<std::pair<std::string, std::vector<std::string>>> columns{};
};

/// Recognizes and checks files of one kind, for `check`.
struct FileReader {
  std::string kind{};
  bool (*recognizes_file)(const std::string& file){};       ///< by its name; null: a document
  bool (*recognizes_document)(const Document& document){};  ///< null: by the schema line or by `key`
  std::string key{};                                        ///< that documents of this kind alone have
  FileSummary (*check)(const std::string& file, const ReadOptions& options){};
};

/// Reads what a key of a mission file names.
struct MissionKey {
  std::string key{};
  void (*read)(MissionRequest& mission,
               const Node& node){};  ///< after stations, legs and visits; null: nothing
  /// Reads the file that the key names, if the mission has it; null: none.
  void (*read_file)(const MissionRequest& mission, MissionWorld& world){};
};

/// Reads a document that stands for a mission; the robot is named on the command line.
struct MissionDocument {
  std::string says{};     ///< "a VDA 5050 order"
  std::string use{};      ///< where it is accepted, for the hint of an error
  std::string example{};  ///< of `plan`
  bool (*recognizes)(const Document& document){};
  void (*read)(MissionRequest& mission){};                       ///< has its file
  std::vector<std::string> (*notes)(const std::string& file){};  ///< what is doubtful; null: nothing
};

/// Reads what a file of another program says about a robot, for `init --from`.
struct RobotSource {
  std::string says{};                                  ///< "a URDF, SDF or MJCF model"
  bool (*recognizes_file)(const std::string& file){};  ///< by its first characters; null: a document
  bool (*recognizes_document)(const Document& document){};
  RobotDraft (*read)(const std::string& file, const std::vector<std::string>& wheels){};
};

/// Reads route graphs that are no documents, for `route_graph:`.
struct GraphSource {
  std::string says{};  ///< "a plant model of openTCS"
  bool (*recognizes)(const std::string& file){};
  ForeignGraph (*read)(const std::string& file){};
};

struct ExportFormat {
  std::string name{};
  std::string says{};
  Export (*write)(const ExportInput&){};
  std::string (*write_log)(const Trajectory&, const Geometry&){};  ///< of a log; null: of plans alone
  std::string example{};                                           ///< for the help; empty: none
};

/// What the extensions add to the formats of the core. Design: docs/decisions/0800-build.md
struct Registry {
  std::vector<LogReader> logs{};
  std::vector<MessageReader> messages{};
  std::vector<FileReader> files{};
  std::vector<FileKind> kinds{};
  std::vector<MissionKey> mission_keys{};
  std::vector<MissionDocument> mission_documents{};
  std::vector<RobotSource> robots{};
  std::vector<GraphSource> graphs{};
  std::vector<ExportFormat> exports{};
};

[[nodiscard]] const Registry& registry();

/// A word of an extension's file `adds`, which this program has or not.
struct Addition {
  std::string_view extension{};
  std::string_view part{};  ///< command, option, export, key, kind, file, folder, document, lines or messages
  std::string_view name{};  ///< document, lines: keys, separated by blanks
  bool is_built{};
};

/// Made by CMake from JOULEPATH_EXTENSIONS (cmake/joulepath_extension.cmake): calls add_NAME() of each.
void add_extensions(Registry& registry);
/// The words of all extensions, those that were not built included.
[[nodiscard]] const std::vector<Addition>& known_additions();

/// The extension that a word needs and that this program was built without; empty: none.
[[nodiscard]] std::string_view absent_extension(std::string_view part, std::string_view name);

/// "a program with the extension nav2", and how to build one.
[[nodiscard]] std::string accepted_extension(std::string_view extension);
[[nodiscard]] std::string extension_hint(std::string_view extension);

/// These throw ConfigError for an input that needs an extension which this program was built without: a key
/// or a kind at its place, a file by its name or its first line, a document by its keys.
void refuse_absent_word(std::string_view part, const std::string& word, const Node& place);
void refuse_absent_file(const std::string& file, const NamedBy& named_by = {});
void refuse_absent_document(const Document& document);

}  // namespace joulepath
