/** The one list of formats: a new one adds a line here. */
#include "ImportFormat.h"

namespace taut
{
const std::vector<ImportFormat>& importFormats()
{
    static const std::vector<ImportFormat> formats{};
    return formats;
}
}  // namespace taut
