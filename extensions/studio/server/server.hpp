#pragma once

#include <functional>
#include <string>

#include "extensions/studio/answer/session.hpp"
#include "extensions/studio/server/mission_files.hpp"

namespace joulepath::studio {

struct ServerOptions {
  int port{};                 ///< 0: any that is free
  std::string diagnosis{};    ///< diagnosis.json with signals that the page shows; empty: none
  std::string page_folder{};  ///< empty: the page that the program holds
};

/// The data that the page starts with: files, floor, schemas. `answer`: a first plan, or ""; `diagnosis`: as
/// ServerOptions has it.
[[nodiscard]] nlohmann::json page_data(const MissionFiles& files, const MissionWorld& floor,
                                       const std::string& answer, const std::string& diagnosis);

/// Serves the studio of one mission on the loopback interface until the program ends. Every address begins
/// with a random token. Requests of other sites (Host, Origin) and those without the token are refused before
/// their bodies are read; serve_http bounds what a request takes. `ready` is called with the address. Throws
/// std::system_error where no port is free.
void serve(MissionFiles& files, const ServerOptions& options,
           const std::function<void(const std::string& address)>& ready);

}  // namespace joulepath::studio
