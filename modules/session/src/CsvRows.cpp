#include "CsvRows.h"

#include <algorithm>
#include <stdexcept>

namespace taut
{
CsvRows::CsvRows(const std::string& path) : file_(path)
{
    std::string line;
    if (!std::getline(file_, line)) throw std::runtime_error("cannot read '" + path + "'");
    names_ = split(line);
}

int CsvRows::column(const std::string& name) const
{
    const auto at = std::find(names_.begin(), names_.end(), name);
    return at == names_.end() ? -1 : static_cast<int>(at - names_.begin());
}

bool CsvRows::next(std::vector<std::string>& row)
{
    std::string line;
    if (!std::getline(file_, line)) return false;
    row = split(line);
    return row.size() == names_.size();
}

std::vector<std::string> CsvRows::split(const std::string& line)
{
    std::vector<std::string> values(1);
    bool quoted = false;
    for (const char c : line)
        if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            values.emplace_back();
        else
            values.back() += c;
    return values;
}
}  // namespace taut
