// Answers requests of ikgen's verification; the format is that of ikgen.verify.runners.program_runner.
use solver::{forward, jacobian, solve, Joints, Options, Pose, Solutions, Status, DOF, FREE, MAX_SOLUTIONS};

fn take<const N: usize>(items: &mut impl Iterator<Item = f64>) -> [f64; N] {
    std::array::from_fn(|_| items.next().expect("the request ends early"))
}

fn take_pose(items: &mut impl Iterator<Item = f64>) -> Pose {
    let t: [f64; 16] = take(items);
    std::array::from_fn(|r| std::array::from_fn(|c| t[4 * c + r]))
}

fn put(out: &mut Vec<f64>, found: &Solutions) {
    out.push(match found.status {
        Status::Ok => 0.0,
        Status::Unreachable => 1.0,
        Status::Limits => 2.0,
        Status::Invalid => 3.0,
    });
    out.push(found.rows.len() as f64);
    for k in 0..MAX_SOLUTIONS {
        let row = found.rows.get(k);
        out.extend(row.map_or([0.0; DOF], |row| row.q));
        out.push(f64::from(row.is_some_and(|row| row.singular)));
    }
}

fn main() {
    let names: Vec<String> = std::env::args().collect();
    let bytes = std::fs::read(&names[1]).expect("no request");
    let mut items = bytes.chunks_exact(8).map(|b| f64::from_ne_bytes(b.try_into().unwrap()));
    let [mode, n, has_free, has_seed, limits] = take(&mut items);
    let mut out = Vec::new();
    if mode == 0.0 {
        out = [DOF, FREE, MAX_SOLUTIONS].map(|x| x as f64).to_vec();
    }
    for _ in 0..n as usize {
        if mode == 1.0 {
            let pose = take_pose(&mut items);
            let mut options = Options { limits: limits != 0.0, ..Options::default() };
            if has_free != 0.0 {
                options.free = take(&mut items);
            }
            if has_seed != 0.0 {
                options.seed = Some(take(&mut items));
            }
            put(&mut out, &solve(&pose, &options));
            continue;
        }
        let q: Joints = take(&mut items);
        if mode == 2.0 {
            let pose = forward(&q);
            out.extend((0..16).map(|i| pose[i % 4][i / 4]));
        } else {
            let slope = jacobian(&q);
            out.extend((0..6 * DOF).map(|i| slope[i % 6][i / 6]));
        }
    }
    let bytes: Vec<u8> = out.iter().flat_map(|x| x.to_ne_bytes()).collect();
    std::fs::write(&names[2], bytes).expect("cannot answer");
}
