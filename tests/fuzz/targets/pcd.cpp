#include "../../../modules/importing/src/folder/readCloud.h"
#include "support.h"
#include "taut/files/PcdFile.h"

/* A PCD file as a table and as a sweep. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    const std::string path = folder.write("1.5.pcd", input);
    fuzz::readOrRefuse(
        [&]
        {
            PcdReader reader(path);
            std::size_t rows = 0;
            for (std::vector<double> row; reader.next(row); rows++)
                fuzz::require(row.size() == reader.columns().size(), "a value a column");
            fuzz::require(rows == reader.size(), "as many rows as the header says");
        });
    fuzz::readOrRefuse([&] { readCloud(path); });
}
