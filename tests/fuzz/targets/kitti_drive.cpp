#include "imported.h"

namespace
{
using Names = std::vector<std::string>;

/** The files of a drive of each of KITTI's data sets, as its reader looks for them. */
struct DataSet
{
    std::string drive;
    Names files;
};

const std::vector<DataSet> kDataSets{
    {"raw/0001_extract",
     {"raw/0001_extract/velodyne_points/timestamps_start.txt",
      "raw/0001_extract/velodyne_points/timestamps_end.txt", "raw/calib_imu_to_velo.txt",
      "raw/0001_extract/oxts/timestamps.txt", "raw/0001_extract/oxts/data/0000000000.txt",
      "raw/0001_extract/velodyne_points/data/0000000000.bin",
      "raw/0001_extract/velodyne_points/data/0000000001.txt"}},
    {"360/data_3d_raw/drive",
     {"360/data_3d_raw/drive/velodyne_points/timestamps.txt",
      "360/calibration/calib_cam_to_pose.txt", "360/calibration/calib_cam_to_velo.txt",
      "360/data_poses/drive/oxts/timestamps.txt", "360/data_poses/drive/oxts/data/0000000000.txt",
      "360/data_3d_raw/drive/velodyne_points/data/0000000000.bin",
      "360/data_3d_raw/drive/velodyne_points/data/0000000001.bin"}},
    {"odometry/00",
     {"odometry/00/times.txt", "odometry/00/velodyne/000000.bin",
      "odometry/00/velodyne/000001.bin"}}};
}  // namespace

/* A drive of KITTI: a byte for the data set, a piece for each of its files. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    const DataSet& set = kDataSets[input.byte() % kDataSets.size()];
    folder.writePieces(input, set.files);
    fuzz::readOrRefuse([&] { fuzz::importAll(folder / set.drive); });
}
