// Pinocchio's forward kinematics of the benchmark's arm: time for all poses and the tips it found.
// Usage: pinocchio POSES COUNT PARAMETERS TIPS.  Files of doubles: (COUNT, 7) in, 27 in, (COUNT, 3) out.
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/multibody.hpp>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace pin = pinocchio;

static std::vector<double> read(const char* path, size_t count) {
    std::vector<double> values(count);
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(values.data()), count * sizeof(double));
    return values;
}

int main(int, char** argv) {
    const size_t count = std::stoul(argv[2]);
    const std::vector<double> q = read(argv[1], count * 7), x = read(argv[3], 27);
    pin::Model model;
    pin::JointIndex parent = 0;
    pin::SE3 placement = pin::SE3::Identity();
    for (int i = 0; i < 7; ++i) {
        const pin::SE3 zero(Eigen::AngleAxisd(i < 6 ? -x[4 * i] : 0.0, Eigen::Vector3d::UnitZ()).matrix(),
                            Eigen::Vector3d::Zero());
        parent = model.addJoint(parent, pin::JointModelRZ(), placement * zero, "joint" + std::to_string(i));
        if (i < 6)
            placement = pin::SE3(Eigen::AngleAxisd(x[4 * i + 1], Eigen::Vector3d::UnitX()).matrix(),
                                 Eigen::Vector3d(x[4 * i + 2], 0.0, x[4 * i + 3]));
    }
    pin::Data data(model);
    const Eigen::Vector3d tip(x[24], x[25], x[26]);
    std::vector<double> tips(count * 3);
    Eigen::VectorXd turn(7);
    double best = 1e300;
    for (int repeat = 0; repeat < 3; ++repeat) {
        const auto since = std::chrono::steady_clock::now();
        for (size_t k = 0; k < count; ++k) {
            turn = Eigen::Map<const Eigen::VectorXd>(&q[7 * k], 7);
            pin::forwardKinematics(model, data, turn);
            const Eigen::Vector3d found = data.oMi[parent].act(tip);
            std::copy_n(found.data(), 3, tips.begin() + 3 * k);
        }
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count());
    }
    std::ofstream(argv[4], std::ios::binary).write(reinterpret_cast<const char*>(tips.data()), tips.size() * sizeof(double));
    std::printf("{\"version\": \"%s\", \"forward_s\": %.9g}\n", PINOCCHIO_VERSION, best);
}
