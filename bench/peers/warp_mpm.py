# SPDX-License-Identifier: Apache-2.0
"""MLS-MPM with the Drucker-Prager law in Warp on the processor: a block of sand collapses."""
import mpm_setup as setup
import numpy as np
import warp as wp

options = setup.arguments()
# Warp runs kernels of the processor in one thread.
options.threads = 1
block = setup.Block(options.particles)
wp.config.quiet = True
wp.init()

STEP, CELL = wp.constant(setup.STEP), wp.constant(setup.CELL)
MU, LAMBDA = wp.constant(setup.LAME_MU), wp.constant(setup.LAME_LAMBDA)
CONE, FALL = wp.constant(setup.CONE), wp.constant(setup.GRAVITY * setup.STEP)
MASS, VOLUME = wp.constant(block.mass), wp.constant(block.volume)


@wp.func
def weight(offset: float, node: int):
    """Returns the quadratic spline's weight of one of three nodes along an axis."""
    if node == 0:
        return 0.5 * (1.5 - offset) * (1.5 - offset)
    if node == 1:
        return 0.75 - (offset - 1.0) * (offset - 1.0)
    return 0.5 * (offset - 0.5) * (offset - 0.5)


@wp.func
def projected(strain: wp.vec3):
    """Returns the elastic strain on or inside the yield cone."""
    volume = strain[0] + strain[1] + strain[2]
    mean = wp.vec3(volume / 3.0, volume / 3.0, volume / 3.0)
    shear = strain - mean
    size = wp.length(shear)
    if volume >= 0.0 or size == 0.0:
        return mean * wp.where(volume > 0.0, 0.0, 1.0)
    most = -(3.0 * LAMBDA + 2.0 * MU) / (2.0 * MU) * volume * CONE
    if size > most:
        return mean + shear * (most / size)
    return strain


@wp.kernel
def scatter(
    position: wp.array(dtype=wp.vec3),
    velocity: wp.array(dtype=wp.vec3),
    affine: wp.array(dtype=wp.mat33),
    deformation: wp.array(dtype=wp.mat33),
    momentum: wp.array3d(dtype=wp.vec3),
    mass: wp.array3d(dtype=float),
):
    p = wp.tid()
    f = deformation[p] + STEP * (affine[p] * deformation[p])
    u = wp.mat33()
    v = wp.mat33()
    sig = wp.vec3()
    wp.svd3(f, u, sig, v)
    strain = projected(
        wp.vec3(
            wp.log(wp.max(sig[0], 0.05)),
            wp.log(wp.max(sig[1], 0.05)),
            wp.log(wp.max(sig[2], 0.05)),
        )
    )
    stretch = wp.vec3(wp.exp(strain[0]), wp.exp(strain[1]), wp.exp(strain[2]))
    deformation[p] = u * wp.diag(stretch) * wp.transpose(v)
    pressure = LAMBDA * (strain[0] + strain[1] + strain[2])
    pull = 2.0 * MU * strain + wp.vec3(pressure, pressure, pressure)
    stress = u * wp.diag(pull) * wp.transpose(u)
    flow = (-STEP * VOLUME * 4.0 / (CELL * CELL)) * stress + MASS * affine[p]
    x = position[p] / CELL
    bx = int(x[0] - 0.5)
    by = int(x[1] - 0.5)
    bz = int(x[2] - 0.5)
    for i in range(3):
        for j in range(3):
            for k in range(3):
                share = (
                    weight(x[0] - float(bx), i)
                    * weight(x[1] - float(by), j)
                    * weight(x[2] - float(bz), k)
                )
                away = CELL * (wp.vec3(float(bx + i), float(by + j), float(bz + k)) - x)
                wp.atomic_add(
                    momentum, bx + i, by + j, bz + k, share * (MASS * velocity[p] + flow * away)
                )
                wp.atomic_add(mass, bx + i, by + j, bz + k, share * MASS)


@wp.kernel
def update_grid(momentum: wp.array3d(dtype=wp.vec3), mass: wp.array3d(dtype=float)):
    i, j, k = wp.tid()
    if mass[i, j, k] > 0.0:
        v = momentum[i, j, k] / mass[i, j, k] - wp.vec3(0.0, 0.0, FALL)
        # Rough ground and closed sides.
        if k <= 3:
            v = wp.vec3(0.0, 0.0, 0.0)
        if i < 2 or i > mass.shape[0] - 3:
            v = wp.vec3(0.0, v[1], v[2])
        if j < 2 or j > mass.shape[1] - 3:
            v = wp.vec3(v[0], 0.0, v[2])
        momentum[i, j, k] = v


@wp.kernel
def gather(
    position: wp.array(dtype=wp.vec3),
    velocity: wp.array(dtype=wp.vec3),
    affine: wp.array(dtype=wp.mat33),
    momentum: wp.array3d(dtype=wp.vec3),
):
    p = wp.tid()
    x = position[p] / CELL
    bx = int(x[0] - 0.5)
    by = int(x[1] - 0.5)
    bz = int(x[2] - 0.5)
    v = wp.vec3()
    rate = wp.mat33()
    for i in range(3):
        for j in range(3):
            for k in range(3):
                share = (
                    weight(x[0] - float(bx), i)
                    * weight(x[1] - float(by), j)
                    * weight(x[2] - float(bz), k)
                )
                away = CELL * (wp.vec3(float(bx + i), float(by + j), float(bz + k)) - x)
                node = momentum[bx + i, by + j, bz + k]
                v += share * node
                rate += (4.0 * share / (CELL * CELL)) * wp.outer(node, away)
    velocity[p] = v
    affine[p] = rate
    position[p] = position[p] + STEP * v


N = block.count
places = np.array([block.position(index) for index in range(N)], dtype=np.float32)
wp.set_device("cpu")
positions = wp.array(places, dtype=wp.vec3)
velocities = wp.zeros(N, dtype=wp.vec3)
affines = wp.zeros(N, dtype=wp.mat33)
identity = np.broadcast_to(np.eye(3, dtype=np.float32), (N, 3, 3)).copy()
deformations = wp.array(identity, dtype=wp.mat33)
momenta = wp.zeros(block.nodes, dtype=wp.vec3)
masses = wp.zeros(block.nodes, dtype=float)


def run(steps):
    """Advances by `steps` time steps."""
    for _ in range(steps):
        momenta.zero_()
        masses.zero_()
        wp.launch(
            scatter, N, inputs=[positions, velocities, affines, deformations, momenta, masses]
        )
        wp.launch(update_grid, block.nodes, inputs=[momenta, masses])
        wp.launch(gather, N, inputs=[positions, velocities, affines, momenta])
    wp.synchronize()


setup.measure("Warp", wp.__version__, options, N, setup.STEP, run)
if not np.isfinite(positions.numpy()).all():
    raise SystemExit("warp_mpm.py: a position is not finite")
