# `./dev release` fills in the address and the checksum of the source archive.
class Joulepath < Formula
  desc "Energy-optimal planner and sim-to-real diagnosis for differential-drive robots"
  url "@URL@"
  version "0.1.0"
  sha256 "@SHA256@"
  license "BSD-3-Clause"

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build
  depends_on "pkgconf" => :build
  depends_on "boost"
  depends_on "eigen"
  depends_on "ipopt"
  depends_on "libpng"
  depends_on :linux
  depends_on "lz4"
  depends_on "nlopt"
  depends_on "ompl"
  depends_on "sqlite"
  depends_on "tinyxml2"
  depends_on "yaml-cpp"
  depends_on "zlib"
  depends_on "zstd"

  def install
    options = %w[-DJOULEPATH_UNITY=ON -DJOULEPATH_BUILD_TESTS=OFF -DJOULEPATH_BUILD_BENCHMARKS=OFF]
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", *options, *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    system bin/"joulepath", "plan", pkgshare/"scenarios/missions/warehouse_pick.yaml", "--out", testpath/"demo"
  end
end
