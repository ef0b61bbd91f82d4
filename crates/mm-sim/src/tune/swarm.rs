//! Particle swarm optimization in the unit cube.

use crate::random::{noise_at, split_mix};

/// Size, length and coefficients of a swarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swarm {
    /// Particles.
    pub particles: u32,
    /// How often each particle is evaluated.
    pub iterations: u32,
    /// Seed of every random number.
    pub seed: u64,
    /// w of (4.45).
    pub inertia_weight: f64,
    /// c1 of (4.45).
    pub cognitive: f64,
    /// c2 of (4.45).
    pub social: f64,
}

/// What is left of a velocity at an edge.
const BOUNCE: f64 = -0.5;

/// A point and its cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// The point of the unit cube.
    pub position: Vec<f64>,
    /// Its cost; infinite before any was found.
    pub cost: f64,
}

struct Particle {
    position: Vec<f64>,
    velocity: Vec<f64>,
    best: Point,
}

impl Swarm {
    /// The best point that the swarm finds, the first of equals; none if `evaluate` gives none.
    ///
    /// Equation: v <- w v + c1 r1 (p - x) + c2 r2 (g - x) (4.45), x <- x + v (4.46), with r1 and r2 drawn anew for every
    /// particle, dimension and iteration, uniform in [0, 1); p is the particle's own best, g the swarm's. A coordinate that leaves
    /// [0, 1] stays at its edge and bounces back with half its velocity: were it stopped, a swarm whose bests are all on an edge
    /// could never leave it. The first particle starts at `start`, the others anywhere, each with half the way to a random
    /// point as its velocity.
    ///
    /// `evaluate` gets all positions of an iteration and gives their costs in the same order, so that it may do them in parallel:
    /// bests are updated between iterations, in the order of the particles, and every random number follows from the seed and its
    /// place alone. A cost that is NaN is never a best.
    ///
    /// # Source
    /// J. Kennedy, R. Eberhart, Particle swarm optimization, ICNN 1995.
    pub fn minimize(
        &self,
        start: &[f64],
        mut evaluate: impl FnMut(&[Vec<f64>]) -> Option<Vec<f64>>,
    ) -> Option<Point> {
        let mut particles = self.initial(start);
        let mut best = Point { position: start.to_vec(), cost: f64::INFINITY };
        for iteration in 0..self.iterations {
            if iteration > 0 {
                self.advance(iteration, &mut particles, &best.position);
            }
            let positions: Vec<Vec<f64>> = particles.iter().map(|p| p.position.clone()).collect();
            let costs = evaluate(&positions)?;
            for (particle, cost) in particles.iter_mut().zip(costs) {
                let here = || Point { position: particle.position.clone(), cost };
                if cost < best.cost {
                    best = here();
                }
                if cost < particle.best.cost {
                    particle.best = here();
                }
            }
        }
        Some(best)
    }

    /// Uniform in [0, 1), a number of its own for each place.
    fn unit(&self, iteration: u32, place: usize) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "particles times dimensions are far below 2^53")]
        let index = place as f64;
        0.5 * (1.0 + noise_at(split_mix(self.seed).wrapping_add(u64::from(iteration)), index))
    }

    fn initial(&self, start: &[f64]) -> Vec<Particle> {
        let dimensions = start.len();
        let particle = |number: usize| {
            let draw = |i: usize, which: usize| self.unit(0, (number * dimensions + i) * 2 + which);
            let position: Vec<f64> = match number {
                0 => start.to_vec(),
                _ => (0..dimensions).map(|i| draw(i, 0)).collect(),
            };
            let velocity = position.iter().enumerate().map(|(i, x)| 0.5 * (draw(i, 1) - x)).collect();
            let best = Point { position: position.clone(), cost: f64::INFINITY };
            Particle { position, velocity, best }
        };
        (0..self.particles as usize).map(particle).collect()
    }

    /// (4.45) and (4.46) for every particle.
    fn advance(&self, iteration: u32, particles: &mut [Particle], best: &[f64]) {
        for (number, particle) in particles.iter_mut().enumerate() {
            let dimensions = best.len();
            let moving = particle.position.iter_mut().zip(&mut particle.velocity);
            for (i, ((x, v), (own, all))) in moving.zip(particle.best.position.iter().zip(best)).enumerate() {
                let place = (number * dimensions + i) * 2;
                let (r1, r2) = (self.unit(iteration, place), self.unit(iteration, place + 1));
                *v = self.inertia_weight * *v
                    + self.cognitive * r1 * (own - *x)
                    + self.social * r2 * (all - *x);
                let moved = *x + *v;
                *x = moved.clamp(0.0, 1.0);
                if !(0.0..=1.0).contains(&moved) {
                    *v *= BOUNCE;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SWARM: Swarm = Swarm {
        particles: 20,
        iterations: 150,
        seed: 1,
        inertia_weight: 0.7298,
        cognitive: 1.49618,
        social: 1.49618,
    };

    fn minimize(swarm: Swarm, dimensions: usize, cost: impl Fn(&[f64]) -> f64) -> Point {
        let evaluate = |all: &[Vec<f64>]| {
            let inside = all.iter().flatten().all(|x| (0.0..=1.0).contains(x));
            assert!(inside && all.len() == swarm.particles as usize, "every particle, in the cube: {all:?}");
            Some(all.iter().map(|x| cost(x)).collect())
        };
        swarm.minimize(&vec![0.5; dimensions], evaluate).expect("a best point")
    }

    /// Law: the swarm contracts on the one minimum. Reference: its place. Tolerance: 1e-6 of the cube, which 3,000 evaluations of a
    /// contracting swarm leave far behind and 3,000 random points do not reach.
    #[test]
    fn finds_the_minimum_of_a_sphere_from_any_seed() {
        let center = [0.3, 0.71, 0.02, 0.9];
        for seed in 0..10 {
            let sphere = |x: &[f64]| x.iter().zip(center).map(|(x, c)| (x - c) * (x - c)).sum();
            let best = minimize(Swarm { seed, ..SWARM }, 4, sphere);
            assert!(best.cost < 1e-12, "seed {seed}: {best:?}");
            assert!(best.position.iter().zip(center).all(|(x, c)| (x - c).abs() < 1e-6), "{best:?}");
        }
    }

    /// A bent valley: the minimum 0 is at (1, 1) of [-2, 2]^2.
    #[test]
    fn follows_the_valley_of_rosenbrock() {
        for seed in 0..10 {
            let rosenbrock = |u: &[f64]| {
                let (x, y) = (4.0 * u[0] - 2.0, 4.0 * u[1] - 2.0);
                (1.0 - x) * (1.0 - x) + 100.0 * (y - x * x) * (y - x * x)
            };
            let best = minimize(Swarm { seed, iterations: 400, ..SWARM }, 2, rosenbrock);
            assert!(best.cost < 1e-6, "seed {seed}: {best:?}");
            assert!(best.position.iter().all(|u| (4.0 * u - 3.0).abs() < 5e-3), "{best:?}");
        }
    }

    #[test]
    fn a_minimum_on_the_edge_is_reached() {
        let best = minimize(SWARM, 3, |x| x.iter().sum());
        assert_eq!(best, Point { position: vec![0.0; 3], cost: 0.0 }, "the corner itself");
    }

    #[test]
    fn the_start_counts_and_nan_does_not() {
        let one = Swarm { particles: 5, iterations: 1, ..SWARM };
        let best = minimize(one, 2, |x| if x == [0.5, 0.5] { 1.0 } else { f64::NAN });
        assert_eq!(best, Point { position: vec![0.5, 0.5], cost: 1.0 }, "the start");
        let never = minimize(one, 2, |_| f64::NAN);
        assert!(never.cost.is_infinite(), "no cost at all: {never:?}");
        assert_eq!(one.minimize(&[0.5], |_| None), None, "asked to stop");
    }

    #[test]
    fn another_seed_is_another_swarm() {
        let short = Swarm { iterations: 2, ..SWARM };
        let of = |seed| minimize(Swarm { seed, ..short }, 3, |x| x.iter().map(|x| (x - 0.4).abs()).sum());
        assert_eq!(of(3), of(3), "one seed, one result");
        assert_ne!(of(3), of(4), "two seeds, two results");
    }
}
