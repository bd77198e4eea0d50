#pragma once

#include "taut/rawlog/ItemSource.h"

namespace taut
{
using ImportedItem = RecordedItem;
using ImportSource = ItemSource;
}  // namespace taut
