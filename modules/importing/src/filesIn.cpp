#include "filesIn.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

namespace taut
{
namespace fs = std::filesystem;

namespace
{
bool isDigit(char c)
{
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool naturallyLess(const std::string& a, const std::string& b)
{
    std::size_t i = 0, k = 0;
    while (i < a.size() && k < b.size())
    {
        if (isDigit(a[i]) && isDigit(b[k]))
        {
            const auto number = [](const std::string& s, std::size_t& at)
            {
                while (at + 1 < s.size() && s[at] == '0' && isDigit(s[at + 1])) at++;
                const std::size_t begin = at;
                while (at < s.size() && isDigit(s[at])) at++;
                return s.substr(begin, at - begin);
            };
            const std::string m = number(a, i), n = number(b, k);
            if (m.size() != n.size()) return m.size() < n.size();
            if (m != n) return m < n;
        }
        else if (a[i] != b[k])
            return a[i] < b[k];
        else
        {
            i++;
            k++;
        }
    }
    return a.size() - i < b.size() - k;
}
}  // namespace

std::vector<fs::path> filesIn(const fs::path& folder)
{
    std::error_code error;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (entry.is_regular_file()) files.push_back(entry.path());
    if (error)
        throw std::runtime_error("cannot read '" + folder.string() + "': " + error.message());
    std::sort(
        files.begin(), files.end(),
        [](const fs::path& a, const fs::path& b)
        { return naturallyLess(a.filename().string(), b.filename().string()); });
    return files;
}

double FileQueue::progress() const
{
    return files_.empty() ? 1 : static_cast<double>(next_) / static_cast<double>(files_.size());
}

std::optional<Scan> FileQueue::nextScan(
    const std::function<Scan(const fs::path&)>& read, const WarningSink& warn)
{
    while (next_ < files_.size())
    {
        const fs::path& file = files_[next_++];
        try
        {
            return read(file);
        }
        catch (const std::runtime_error& e)
        {
            if (warn) warn({0, "scan_invalid", std::string(e.what()) + "; left out"});
        }
    }
    return {};
}
}  // namespace taut
