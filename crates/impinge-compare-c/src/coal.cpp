// Coal's queries of two shapes, many pairs in one call; the functions that `coal.rs` declares.

#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>
#include <coal/contact_patch.h>
#include <coal/distance.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

using namespace coal;

namespace {

/// A geometry, and how it is turned in the frame of those who ask: Coal's axes go along z, theirs along y.
struct Solid {
    std::shared_ptr<CollisionGeometry> geometry;
    bool is_along_z;
    bool is_mesh;
};

using Pose = Transform3s;

/// What is kept of a pair from one question to the next.
struct Kept {
    CollisionRequest collision;
    DistanceRequest distance;
    CollisionResult contacts;
    ContactPatchResult patches;
};

struct Pairs {
    Solid solids[2];
    std::vector<Pose> first;
    std::vector<std::vector<Pose>> second;
    std::size_t most;
    ComputeCollision collide;
    ComputeDistance measure;
    ComputeContactPatch patch;
    std::vector<Kept> kept;
    /// Coal has no algorithm for the two shapes: it threw.
    bool has_none = false;

    Pairs(const Solid &a, const Solid &b)
        : solids{a, b},
          // Of convex shapes there is one contact; of a mesh the deepest of all is wanted.
          most(a.is_mesh || b.is_mesh ? 10000 : 1), collide(a.geometry.get(), b.geometry.get()),
          measure(a.geometry.get(), b.geometry.get()), patch(a.geometry.get(), b.geometry.get()) {}

    std::vector<Pose> poses(const double *numbers, std::size_t count, const Solid &solid) const {
        const Matrix3s turn = (Matrix3s() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
        std::vector<Pose> poses;
        for (std::size_t n = 0; n < count; ++n, numbers += 7) {
            const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
            Matrix3s matrix = rotation.normalized().toRotationMatrix();
            if (solid.is_along_z) matrix = matrix * turn;
            poses.emplace_back(matrix, Vec3s(numbers[0], numbers[1], numbers[2]));
        }
        return poses;
    }

    /// Asks for every pair, with the pose of its second solid in a set.
    template <class Ask> void each(std::size_t set, Ask ask) {
        try {
            for (std::size_t n = 0; n < first.size() && !has_none; ++n) ask(n, first[n], second[set][n]);
        } catch (...) {
            has_none = true;
        }
    }

    /// The same, with answers, which are no numbers where there is no algorithm.
    template <class Ask> void answer(std::size_t set, float *answers, Ask ask) {
        each(set, [&](std::size_t n, const Pose &a, const Pose &b) { answers[n] = ask(kept[n], a, b); });
        if (has_none) std::fill_n(answers, first.size(), std::numeric_limits<float>::quiet_NaN());
    }

    float deepest(const CollisionResult &contacts) const {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t n = 0; n < contacts.numContacts(); ++n)
            least = std::min(least, contacts.getContact(n).penetration_depth);
        return static_cast<float>(least);
    }
};

Solid *solid(CollisionGeometry *geometry, bool is_along_z = false, bool is_mesh = false) {
    geometry->computeLocalAABB();
    return new Solid{std::shared_ptr<CollisionGeometry>(geometry), is_along_z, is_mesh};
}

std::shared_ptr<std::vector<Vec3s>> cloud(const double *numbers, std::size_t count) {
    auto points = std::make_shared<std::vector<Vec3s>>();
    for (std::size_t n = 0; n < count; ++n, numbers += 3)
        points->emplace_back(numbers[0], numbers[1], numbers[2]);
    return points;
}

} // namespace

extern "C" {

Solid *impinge_coal_ball(double radius) { return solid(new Sphere(radius)); }

Solid *impinge_coal_box(const double *half, double radius) {
    auto *box = new Box(2 * half[0], 2 * half[1], 2 * half[2]);
    box->setSweptSphereRadius(radius);
    return solid(box);
}

Solid *impinge_coal_capsule(double half, double radius) { return solid(new Capsule(radius, 2 * half), true); }

Solid *impinge_coal_cylinder(double half, double radius) { return solid(new Cylinder(radius, 2 * half), true); }

Solid *impinge_coal_cone(double half, double radius) { return solid(new Cone(radius, 2 * half), true); }

Solid *impinge_coal_hull(const double *numbers, std::size_t count) {
    auto points = cloud(numbers, count);
    return solid(ConvexBase::convexHull(points, static_cast<unsigned int>(count), true));
}

Solid *impinge_coal_half_space(const double *normal) {
    return solid(new Halfspace(Vec3s(normal[0], normal[1], normal[2]), 0.0));
}

Solid *impinge_coal_mesh(const double *vertices, std::size_t vertex_count, const unsigned int *triangles,
                         std::size_t triangle_count) {
    auto *mesh = new BVHModel<OBBRSS>();
    std::vector<Triangle> faces;
    for (std::size_t n = 0; n < triangle_count; ++n, triangles += 3)
        faces.emplace_back(triangles[0], triangles[1], triangles[2]);
    mesh->beginModel();
    mesh->addSubModel(*cloud(vertices, vertex_count), faces);
    mesh->endModel();
    return solid(mesh, false, true);
}

void impinge_coal_drop_solid(Solid *solid) { delete solid; }

/// Null where Coal has no algorithm for the two shapes: it throws.
Pairs *impinge_coal_pairs(const Solid *a, const Solid *b, const double *first, std::size_t count) try {
    auto pairs = std::make_unique<Pairs>(*a, *b);
    pairs->first = pairs->poses(first, count, *a);
    return pairs.release();
} catch (...) {
    return nullptr;
}

/// Adds a set of poses of the second solids.
void impinge_coal_add_set(Pairs *pairs, const double *second) {
    pairs->second.push_back(pairs->poses(second, pairs->first.size(), pairs->solids[1]));
}

void impinge_coal_drop_pairs(Pairs *pairs) { delete pairs; }

/// Forgets what was kept; `is_warm` has searches begin with the direction that the last one ended with.
void impinge_coal_reset(Pairs *pairs, double margin, bool is_warm) {
    Kept kept;
    kept.collision = CollisionRequest(CONTACT, pairs->most);
    kept.collision.security_margin = margin;
    kept.distance.enable_signed_distance = false;
    if (is_warm) kept.collision.gjk_initial_guess = GJKInitialGuess::CachedGuess;
    pairs->kept.assign(pairs->first.size(), kept);
    pairs->has_none = false;
}

void impinge_coal_distances(Pairs *pairs, std::size_t set, float *answers) {
    pairs->answer(set, answers, [&](Kept &kept, const Pose &a, const Pose &b) {
        DistanceResult result;
        pairs->measure(a, b, kept.distance, result);
        return static_cast<float>(std::max(result.min_distance, 0.0));
    });
}

/// The signed distance of the deepest contact, infinite for none.
void impinge_coal_contacts(Pairs *pairs, std::size_t set, float *answers) {
    pairs->answer(set, answers, [&](Kept &kept, const Pose &a, const Pose &b) {
        kept.contacts.clear();
        pairs->collide(a, b, kept.collision, kept.contacts);
        return pairs->deepest(kept.contacts);
    });
}

/// Contacts, and the polygons in which surfaces touch.
void impinge_coal_patches(Pairs *pairs, std::size_t set) {
    const ContactPatchRequest request(pairs->most);
    pairs->each(set, [&](std::size_t n, const Pose &a, const Pose &b) {
        Kept &kept = pairs->kept[n];
        kept.contacts.clear();
        kept.patches.clear();
        pairs->collide(a, b, kept.collision, kept.contacts);
        if (kept.contacts.isCollision()) pairs->patch(a, b, kept.contacts, request, kept.patches);
        kept.collision.updateGuess(kept.contacts);
    });
}

/// The signed distances of the deepest contacts kept by the last call.
void impinge_coal_deepest(const Pairs *pairs, float *answers) {
    for (std::size_t n = 0; n < pairs->kept.size(); ++n)
        answers[n] = pairs->has_none ? std::numeric_limits<float>::quiet_NaN()
                                     : pairs->deepest(pairs->kept[n].contacts);
}
}
