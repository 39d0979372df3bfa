#pragma once

#include <functional>
#include <string>

#include "studio/answer/session.hpp"
#include "studio/server/mission_files.hpp"

namespace joulepath::studio {

struct ServerOptions {
  int port{};                 ///< 0: any free port
  std::string page_folder{};  ///< empty: the page inside the program
};

/// The initial data of the page: files, floor, schemas. `answer`: a first plan, or null.
[[nodiscard]] nlohmann::json page_data(const MissionFiles& files, const MissionWorld& floor,
                                       const std::string& answer);

/// Serves the studio of one mission on the loopback interface until the program ends. Every address begins
/// with a random token. Requests of other sites (Host, Origin) are rejected, and the size of bodies is
/// bounded. `ready` is called with the address. Throws std::system_error where no port is free.
void serve(MissionFiles& files, const ServerOptions& options,
           const std::function<void(const std::string& address)>& ready);

}  // namespace joulepath::studio
