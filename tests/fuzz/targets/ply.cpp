#include "../../../modules/importing/src/folder/readCloud.h"
#include "support.h"
#include "taut/files/PlyFile.h"

/* A PLY file as a table, as a map and as a sweep. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    const std::string path = folder.write("1.5.ply", input);
    fuzz::readOrRefuse(
        [&]
        {
            PlyReader reader(path);
            std::size_t rows = 0;
            for (std::vector<double> row; reader.next(row); rows++)
                fuzz::require(row.size() == reader.columns().size(), "a value a column");
            fuzz::require(rows == reader.size(), "as many rows as the header says");
        });
    fuzz::readOrRefuse([&] { readPlyPoints(path); });
    fuzz::readOrRefuse([&] { readCloud(path); });
}
