// The same mesh and the same rays as benches/rays.rs, which writes them, traced by Embree: single
// rays, medium build quality. Prints rows of `name threads value hits` for that program to read.
//
// usage: embree_rays DIRECTORY [robust]
#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <vector>

template <typename T> static std::vector<T> read_all(const std::string &path) {
    std::vector<T> data;
    FILE *file = std::fopen(path.c_str(), "rb");
    if (!file) { std::perror(path.c_str()); std::exit(1); }
    std::fseek(file, 0, SEEK_END);
    data.resize(size_t(std::ftell(file)) / sizeof(T));
    std::rewind(file);
    if (std::fread(data.data(), sizeof(T), data.size(), file) != data.size()) std::exit(1);
    std::fclose(file);
    return data;
}

static double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Ray { float o[3], d[3], t_max; };

template <bool Shadow> static uint64_t trace(RTCScene scene, const Ray *rays, size_t count) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    uint64_t hits = 0;
    for (size_t i = 0; i < count; ++i) {
        const Ray &r = rays[i];
        RTCRayHit q;
        q.ray.org_x = r.o[0]; q.ray.org_y = r.o[1]; q.ray.org_z = r.o[2];
        q.ray.dir_x = r.d[0]; q.ray.dir_y = r.d[1]; q.ray.dir_z = r.d[2];
        q.ray.tnear = 0; q.ray.tfar = r.t_max; q.ray.time = 0;
        q.ray.mask = ~0u; q.ray.id = 0; q.ray.flags = 0;
        q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        if (Shadow) {
            rtcOccluded1(scene, &context, &q.ray);
            hits += q.ray.tfar < 0;
        } else {
            rtcIntersect1(scene, &context, &q);
            hits += q.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
    }
    return hits;
}

// One thread: the sum over blocks of rays of each block's best time. Two threads: the best time of
// the whole, blocks being taken by whichever thread is free.
template <bool Shadow> static void measure(RTCScene scene, const char *name, const std::vector<Ray> &rays) {
    const size_t block = 4096, blocks = (rays.size() + block - 1) / block, repeats = 8;
    auto run = [&](size_t b) {
        return trace<Shadow>(scene, rays.data() + b * block, std::min(block, rays.size() - b * block));
    };
    for (size_t threads = 1; threads <= 2; ++threads) {
        std::atomic<uint64_t> hits{0};
        double seconds = std::numeric_limits<double>::infinity();
        std::vector<double> best(blocks, seconds);
        for (size_t repeat = 0; repeat < repeats; ++repeat) {
            hits = 0;
            if (threads == 1) {
                for (size_t b = 0; b < blocks; ++b) {
                    const double start = now_s();
                    hits += run(b);
                    best[b] = std::min(best[b], now_s() - start);
                }
                seconds = 0;
                for (double b : best) seconds += b;
                continue;
            }
            std::atomic<size_t> next{0};
            std::vector<std::thread> team;
            const double start = now_s();
            for (size_t k = 0; k < threads; ++k)
                team.emplace_back([&] {
                    for (size_t b; (b = next++) < blocks;) hits += run(b);
                });
            for (auto &t : team) t.join();
            seconds = std::min(seconds, now_s() - start);
        }
        std::printf("%s %zu %.4f %llu\n", name, threads, double(rays.size()) / seconds * 1e-6,
                    (unsigned long long)hits);
    }
}

int main(int argc, char **argv) {
    if (argc < 2) return 2;
    const std::string dir = argv[1];
    const bool robust = argc > 2 && std::strcmp(argv[2], "robust") == 0;
    const auto vertices = read_all<float>(dir + "/vertices");
    const auto triangles = read_all<uint32_t>(dir + "/triangles");
    RTCDevice device = rtcNewDevice("threads=2");
    double best = std::numeric_limits<double>::infinity();
    RTCScene scene = nullptr;
    for (int repeat = 0; repeat < 3; ++repeat) {
        if (scene) rtcReleaseScene(scene);
        scene = rtcNewScene(device);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
        if (robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void *v = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices.size() / 3);
        void *t = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.size() / 3);
        std::memcpy(v, vertices.data(), vertices.size() * 4);
        std::memcpy(t, triangles.data(), triangles.size() * 4);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene, mesh);
        rtcReleaseGeometry(mesh);
        const double start = now_s();
        rtcCommitScene(scene);
        best = std::min(best, now_s() - start);
    }
    std::printf("build 2 %.4f 0\n", best * 1e3);
    measure<false>(scene, "primary", read_all<Ray>(dir + "/primary"));
    measure<false>(scene, "bounce", read_all<Ray>(dir + "/bounce"));
    measure<true>(scene, "shadow", read_all<Ray>(dir + "/shadow"));
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
}
