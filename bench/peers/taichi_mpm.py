# SPDX-License-Identifier: Apache-2.0
"""MLS-MPM with the Drucker-Prager law in Taichi on the processor: a block of sand collapses."""
import mpm_setup as setup
import numpy as np
import taichi as ti

options = setup.arguments()
block = setup.Block(options.particles)
ti.init(arch=ti.cpu, default_fp=ti.f32, cpu_max_num_threads=options.threads, log_level=ti.ERROR)

N = block.count
position = ti.Vector.field(3, ti.f32, N)
velocity = ti.Vector.field(3, ti.f32, N)
affine = ti.Matrix.field(3, 3, ti.f32, N)
deformation = ti.Matrix.field(3, 3, ti.f32, N)
momentum = ti.Vector.field(3, ti.f32, block.nodes)
mass = ti.field(ti.f32, block.nodes)


@ti.func
def weights(offset):
    """Returns the quadratic spline's weights of three nodes, for each axis."""
    return [0.5 * (1.5 - offset) ** 2, 0.75 - (offset - 1.0) ** 2, 0.5 * (offset - 0.5) ** 2]


@ti.func
def stress(p):
    """Projects the elastic deformation onto the yield cone; returns the Kirchhoff stress."""
    u, sig, v = ti.svd(deformation[p])
    strain = ti.Vector([ti.log(ti.max(sig[k, k], 0.05)) for k in ti.static(range(3))])
    volume_strain = strain.sum()
    shear = strain - volume_strain / 3.0
    size = shear.norm()
    if volume_strain >= 0.0 or size == 0.0:
        strain = ti.Vector([ti.min(volume_strain, 0.0) / 3.0] * 3)
    else:
        most = (
            -(3.0 * setup.LAME_LAMBDA + 2.0 * setup.LAME_MU)
            / (2.0 * setup.LAME_MU)
            * volume_strain
            * setup.CONE
        )
        if size > most:
            strain = volume_strain / 3.0 + shear * (most / size)
    stretch = ti.Matrix.zero(ti.f32, 3, 3)
    pull = ti.Matrix.zero(ti.f32, 3, 3)
    for k in ti.static(range(3)):
        stretch[k, k] = ti.exp(strain[k])
        pull[k, k] = 2.0 * setup.LAME_MU * strain[k] + setup.LAME_LAMBDA * strain.sum()
    deformation[p] = u @ stretch @ v.transpose()
    return u @ pull @ u.transpose()


@ti.kernel
def scatter():
    for p in position:
        deformation[p] += setup.STEP * (affine[p] @ deformation[p])
        force = -setup.STEP * block.volume * 4.0 / setup.CELL**2 * stress(p)
        flow = force + block.mass * affine[p]
        base = ti.cast(position[p] / setup.CELL - 0.5, ti.i32)
        w = weights(position[p] / setup.CELL - ti.cast(base, ti.f32))
        for i, j, k in ti.static(ti.ndrange(3, 3, 3)):
            node = base + ti.Vector([i, j, k])
            away = ti.cast(node, ti.f32) * setup.CELL - position[p]
            share = w[i][0] * w[j][1] * w[k][2]
            momentum[node] += share * (block.mass * velocity[p] + flow @ away)
            mass[node] += share * block.mass


@ti.kernel
def update_grid():
    for node in ti.grouped(mass):
        if mass[node] > 0.0:
            v = momentum[node] / mass[node] - ti.Vector([0.0, 0.0, setup.GRAVITY * setup.STEP])
            # Rough ground and closed sides.
            if node[2] <= 3:
                v *= 0.0
            for k in ti.static(range(2)):
                if node[k] < 2 or node[k] > block.nodes[k] - 3:
                    v[k] = 0.0
            momentum[node] = v


@ti.kernel
def gather():
    for p in position:
        base = ti.cast(position[p] / setup.CELL - 0.5, ti.i32)
        w = weights(position[p] / setup.CELL - ti.cast(base, ti.f32))
        v = ti.Vector.zero(ti.f32, 3)
        rate = ti.Matrix.zero(ti.f32, 3, 3)
        for i, j, k in ti.static(ti.ndrange(3, 3, 3)):
            node = base + ti.Vector([i, j, k])
            away = ti.cast(node, ti.f32) * setup.CELL - position[p]
            share = w[i][0] * w[j][1] * w[k][2]
            v += share * momentum[node]
            rate += 4.0 / setup.CELL**2 * share * momentum[node].outer_product(away)
        velocity[p] = v
        affine[p] = rate
        position[p] += setup.STEP * v


def run(steps):
    """Advances by `steps` time steps."""
    for _ in range(steps):
        momentum.fill(0)
        mass.fill(0)
        scatter()
        update_grid()
        gather()
    ti.sync()


position.from_numpy(np.array([block.position(i) for i in range(N)], dtype=np.float32))
deformation.from_numpy(np.broadcast_to(np.eye(3, dtype=np.float32), (N, 3, 3)).copy())
setup.measure("Taichi", ".".join(map(str, ti.__version__)), options, N, setup.STEP, run)
if not np.isfinite(position.to_numpy()).all():
    raise SystemExit("taichi_mpm.py: a position is not finite")
