#include "ObjectHeader.h"

#include <algorithm>

namespace taut
{
namespace
{
bool isOfClassNames(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == ':' || c == '<' || c == '>' || c == ',';
}
}  // namespace

std::optional<ObjectHeader> parseObjectHeader(const std::uint8_t* data, std::size_t size)
{
    if (size < 2 || !(data[0] & 0x80)) return {};
    const std::size_t length = data[0] & 0x7f;
    if (length == 0 || length > kLongestClassName || size < length + 2) return {};
    ObjectHeader header;
    header.name.assign(data + 1, data + 1 + length);
    if (!std::all_of(header.name.begin(), header.name.end(), isOfClassNames)) return {};
    header.version = data[1 + length];
    header.bytes = length + 2;
    return header;
}

bool isOfRawlogs(const ObjectHeader& header)
{
    const std::string name = header.shortName();
    return name.rfind("CObservation", 0) == 0 || name == "CSensoryFrame" ||
           name == "CActionCollection";
}
}  // namespace taut
