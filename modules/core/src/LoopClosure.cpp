#include "taut/core/LoopClosure.h"

namespace taut
{
const char* nameOf(Verdict verdict)
{
    switch (verdict)
    {
        case Verdict::Accepted:
            return "accepted";
        case Verdict::Pending:
            return "pending";
        case Verdict::Refused:
            return "refused";
        case Verdict::Withdrawn:
            return "withdrawn";
    }
    return "";
}
}  // namespace taut
