// blind_plant: writes a data set; only its label contains the cause. It shares nothing with the programs
// under test: no header, no library, no formula's implementation, no time stepping.
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "case.hpp"
#include "oracle.hpp"

namespace {

constexpr const char* kUsage =
    "usage: blind_plant --effect NAME[,NAME] [--size X[,X] | --share X[,X]] [--robot "
    "nomad|warehouse|small|tug]\n"
    "                   [--protocol 24|12|6] [--one-log]\n"
    "                   [--level 0|1] [--seed S] [--day D] [--noise F] [--out DIR] [--label FILE|none]\n"
    "                   [--oracle] [--observer]\n"
    "       blind_plant --list\n"
    "  --effect   none, a catalog name, a foreign kind, or up to three of them\n"
    "  --size     the effect's first parameter in its own unit (0 or absent: drawn log-uniform)\n"
    "  --share    shares of a large effect, which is half of the strongest of its range\n"
    "  --out      folder of the data set; absent: the label alone is written\n"
    "  --label    where the label goes, YAML or (*.json) JSON (default: DIR/truth.yaml; `none`: nowhere)\n"
    "  --day      another day of the same machine (default 0): other runs, scatter and noise\n"
    "  --noise    factor on the noise of every channel (default 1)\n"
    "  --append   more runs after the test day: legs key:value,... joined by + (keys of a mission's "
    "`motion:`),\n"
    "             runs by ;\n"
    "  --one-log  the day's motions in one long log, with the payload of the first\n"
    "  --oracle   adds to the label what an all-knowing observer could detect (slower)\n"
    "  --observer the same, and what a single effect could be told apart from (four times as slow)\n";

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::string part;
  for (char c : text + ",") {
    if (c != ',')
      part += c;
    else if (!part.empty())
      parts.push_back(std::exchange(part, ""));
  }
  return parts;
}

int list_names() {
  for (const std::string& name : blind::catalog_names()) std::cout << "catalog " << name << "\n";
  for (const std::string& name : blind::foreign_names()) std::cout << "foreign " << name << "\n";
  return 0;
}

blind::CaseRequest request_of(const std::map<std::string, std::string>& given) {
  const auto get = [&](const std::string& key, const std::string& fallback) {
    const auto at = given.find(key);
    return at == given.end() ? fallback : at->second;
  };
  blind::CaseRequest request;
  for (const std::string& name : split(get("--effect", "none")))
    if (name != "none" && name != "null") request.effects.push_back(name);
  for (const std::string& size : split(get("--size", ""))) request.sizes.push_back(std::stod(size));
  for (const std::string& share : split(get("--share", ""))) request.shares.push_back(std::stod(share));
  request.robot = get("--robot", "nomad");
  request.runs = std::stoi(get("--protocol", "24"));
  request.level = std::stoi(get("--level", "0"));
  request.seed = std::stoull(get("--seed", "1"));
  request.day = std::stoull(get("--day", "0"));
  request.noise = std::stod(get("--noise", "1"));
  std::istringstream appended(get("--append", ""));
  for (std::string one; std::getline(appended, one, ';');) request.appended.push_back(one);
  if (request.runs < 1 || request.runs > 24 || request.level < 0 || request.level > 1 ||
      request.effects.size() > 3)
    throw std::invalid_argument("protocol is 1 to 24 runs, level 0 or 1, at most three effects");
  return request;
}

int run(int argc, char** argv) {
  std::map<std::string, std::string> given;
  bool oracle = false, observer = false, one_log = false;
  for (int k = 1; k < argc; ++k) {
    const std::string key = argv[k];
    if (key == "--list") return list_names();
    if (key == "--oracle")
      oracle = true;
    else if (key == "--observer")
      oracle = observer = true;
    else if (key == "--one-log")
      one_log = true;
    else if (key.rfind("--", 0) == 0 && k + 1 < argc)
      given[key] = argv[++k];
    else
      throw std::invalid_argument("unexpected argument '" + key + "'");
  }
  for (const auto& [key, value] : given)
    if (std::string(" --effect --size --share --robot --protocol --level --seed --day --noise --out --label "
                    "--append ")
            .find(" " + key + " ") == std::string::npos)
      throw std::invalid_argument("unknown option " + key);
  const std::string out = given["--out"];
  const std::string label =
      given.count("--label") ? given["--label"] : (out.empty() ? "" : out + "/truth.yaml");
  if (out.empty() && (label.empty() || label == "none"))
    throw std::invalid_argument("neither --out nor --label");
  blind::CaseRequest request = request_of(given);
  request.one_log = one_log;
  const blind::Case c = blind::draw_case(request);
  if (!out.empty()) blind::write_case(c, out);
  if (label != "none") blind::write_label(c, label, oracle, observer);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "blind_plant: " << error.what() << "\n" << kUsage;
    return 2;
  }
}
