// What the peers share: reading the mesh, the view's criterion, a warm run and a timed one.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

struct Mesh {
    std::vector<double> positions;  // x, y, z
    std::vector<int32_t> faces;     // three corners each
    int vertexCount() const { return int(positions.size() / 3); }
    int faceCount() const { return int(faces.size() / 3); }
};

inline Mesh readMesh(char const *path) {
    FILE *file = std::fopen(path, "rb");
    int32_t counts[2];
    Mesh mesh;
    bool good = file && std::fread(counts, sizeof counts, 1, file) == 1;
    if (good) {
        mesh.positions.resize(3 * counts[0]);
        mesh.faces.resize(3 * counts[1]);
        good = std::fread(mesh.positions.data(), sizeof(double), mesh.positions.size(), file) == mesh.positions.size() &&
               std::fread(mesh.faces.data(), sizeof(int32_t), mesh.faces.size(), file) == mesh.faces.size();
    }
    if (!good) std::exit((std::fprintf(stderr, "%s cannot be read\n", path), 1));
    std::fclose(file);
    return mesh;
}

// Faces that face the eye are refined until no edge is longer than so many pixels.
struct View {
    double eye[3], pixelsPerRadian, edgePixels;

    static View of(char **words) {
        View view;
        for (int i = 0; i < 3; ++i) view.eye[i] = std::atof(words[i]);
        view.pixelsPerRadian = std::atof(words[3]);
        view.edgePixels = std::atof(words[4]);
        return view;
    }

    // How many times too long an edge is.
    template <class Point> double excess(Point const &a, Point const &b) const {
        double length = 0, away = 0;
        for (int i = 0; i < 3; ++i) {
            double d = a[i] - b[i], e = 0.5 * (a[i] + b[i]) - eye[i];
            length += d * d;
            away += e * e;
        }
        return pixelsPerRadian * std::sqrt(length / away) / edgePixels;
    }

    template <class Point> bool faces(Point const &a, Point const &b, Point const &c) const {
        double u[3], v[3], e[3];
        for (int i = 0; i < 3; ++i) u[i] = b[i] - a[i], v[i] = c[i] - a[i], e[i] = eye[i] - a[i];
        return (u[1] * v[2] - u[2] * v[1]) * e[0] + (u[2] * v[0] - u[0] * v[2]) * e[1] +
                   (u[0] * v[1] - u[1] * v[0]) * e[2] > 0;
    }
};

// Runs twice; prints the triangles and milliseconds of the second time.
template <class Run> int report(Run run) {
    run();
    auto begin = std::chrono::steady_clock::now();
    long triangles = run();
    double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    std::printf("%ld %.4f\n", triangles, ms);
    return 0;
}
