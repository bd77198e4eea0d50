#include "SlamArguments.h"

#include <cmath>
#include <map>
#include <sstream>

namespace taut
{
namespace
{
int verbosityOf(const std::string& level)
{
    const std::map<std::string, int> levels{{"ERROR", 0}, {"WARN", 1}, {"INFO", 2}, {"DEBUG", 3}};
    const auto it = levels.find(level);
    if (it == levels.end())
        throw UsageError("-v: '" + level + "' is none of ERROR, WARN, INFO, DEBUG");
    return it->second;
}
/** "x,y,z,yaw" [m, degrees] to numbers [m, rad]. */
std::vector<double> startOf(const std::string& text)
{
    std::vector<double> numbers;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');)
    {
        std::size_t used = 0;
        double number = 0;
        try
        {
            number = std::stod(word, &used);
        }
        catch (const std::exception&)  // told below
        {
            used = 0;
        }
        if (used == 0 || used != word.size() || !std::isfinite(number))
            throw UsageError("--start-at: '" + word + "' is no number");
        numbers.push_back(number);
    }
    if (numbers.size() != 4)
        throw UsageError("--start-at: four numbers are wanted, x,y,z,yaw, in '" + text + "'");
    numbers[3] *= M_PI / 180;
    return numbers;
}
void requireMapFor(const SlamOptions& o, bool localize)
{
    if (localize && o.extend_map) throw UsageError("--localize and --extend exclude each other");
    if (o.map.empty() && (localize || o.extend_map || !o.start_at.empty()))
        throw UsageError("--localize, --extend and --start-at need a map: -m");
}
}  // namespace

SlamArguments::SlamArguments(TCLAP::CmdLine& cmd, FolderOption folder)
    : output_(
          "o", "output",
          folder == FolderOption::Required
              ? "Folder for the results"
              : "Folder for the results (default: named after the recording, with _taut)",
          folder == FolderOption::Required, "", "OUT/", cmd),
      config_(
          "c", "config", "Method file: the choices of the method (default: config/default.yaml)",
          false, "", "METHOD.yaml", cmd),
      set_(
          "s", "set", "Override a key of the method file, as estimation.undistortion=imu", false,
          "SECTION.KEY=VALUE", cmd),
      map_(
          "m", "map", "Results of an earlier run of this place: the run is told in its frame",
          false, "", "EARLIER/", cmd),
      localize_("", "localize", "The map of -m stays as it is (default)", cmd),
      extend_("", "extend", "The map of -m and this run become one map in the folder of -o", cmd),
      start_(
          "", "start-at",
          "Where the run begins in the map of -m, to a metre and ten degrees [m, degrees]", false,
          "", "X,Y,Z,YAW", cmd),
      plugins_(
          "p", "plugin", "Shared library with further classes for the plug points", false,
          "PLUGIN.so", cmd),
      threads_(
          "", "threads", "Threads of the estimation (0: all processors); the result is the same",
          false, 0, "N", cmd),
      overwrite_("w", "overwrite", "Write into a folder that has results", cmd),
      stream_("", "stream", "A line of JSON for each scan on the standard output", cmd),
      no_pictures_("", "no-pictures", "Do not render snapshots", cmd),
      no_report_("", "no-report", "Do not write report.html", cmd),
      quiet_("q", "quiet", "Errors only: as -v ERROR", cmd),
      level_(
          "v", "verbosity", "How much is told (default INFO)", false, "INFO",
          "ERROR|WARN|INFO|DEBUG", cmd)
{
}

void SlamArguments::fill(SlamOptions& o)
{
    o.output = output_.getValue();
    o.config = config_.getValue();
    o.settings = set_.getValue();
    o.map = map_.getValue();
    o.extend_map = extend_.getValue();
    if (!start_.getValue().empty()) o.start_at = startOf(start_.getValue());
    requireMapFor(o, localize_.getValue());
    o.plugins = plugins_.getValue();
    o.threads = threadsOf(threads_.getValue());
    o.overwrite = overwrite_.getValue();
    o.stream = stream_.getValue();
    o.no_pictures = no_pictures_.getValue();
    o.no_report = no_report_.getValue();
    o.verbosity = quiet_.getValue() ? 0 : verbosityOf(level_.getValue());
}
}  // namespace taut
