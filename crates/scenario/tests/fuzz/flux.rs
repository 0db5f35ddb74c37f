//! Tables of flux linkages.
use crate::WORDS;
use servobench_base::Dq;
use servobench_fuzz::{Splice, check, fuzz};
use servobench_plant::pmsm::FluxMap;
use servobench_scenario::read_flux_table;

const TABLES: [&str; 3] = [
    include_str!("../../../../scenarios/hardware/saturation-table.csv"),
    "i_q [Arms],i_d [Apk],psi_q [mV s],psi_d [V s]\n0,-2,0,.1\n1,-2,20,.11\n2,-2,30,.12\n0,0,0,.2\n1,0,21,.21\n2,0,31,.22\n\
     0,1,0,.3\n1,1,22,.31\n2,1,32,.32\n",
    "i_d [mApk],i_q [Apk],psi_d [V s],psi_q [V s]\r\n-1e3,-1,-1,-1\r\n-1e3,0,-1,0\r\n-1e3,1,-1,1\r\n0,-1,0,-1\r\n0,0,0,0\r\n0,1,0,1\r\n\
     5e3,-1,5,-1\r\n5e3,0,5,0\r\n5e3,1,5,1\r\n",
];

/// A table that is read is a grid; a map has a flux for all currents and a conservative energy; a refusal has a place in the text and a
/// reason.
#[test]
fn flux_tables() {
    fuzz(check!(), 2_000, Splice::text(&TABLES, WORDS), |text| match read_flux_table(text) {
        Ok(data) => {
            assert!(data.psi_d.len() == data.i_d.len() * data.i_q.len() && data.psi_q.len() == data.psi_d.len());
            assert!([&data.i_d, &data.i_q].iter().all(|axis| axis.windows(2).all(|pair| pair[0] < pair[1])));
            match FluxMap::table(&data) {
                Ok(map) => {
                    let [a, b, c] = [(-3.0, 1.0), (1e4, -7.0), (0.4, 1e9)].map(|(d, q)| Dq { d, q });
                    let taken = [map.stored(a, b), map.stored(b, c), map.stored(c, a)];
                    let most = taken.iter().fold(0.0, |most: f64, one| most.max(one.abs()));
                    assert!(taken.iter().sum::<f64>().abs() <= 1e-9 * most, "{taken:?}");
                }
                Err(error) => assert!(!error.to_string().contains("NaN"), "{error}"),
            }
        }
        Err(error) => {
            assert!(error.line <= text.lines().count().max(1), "{error}");
            let line = text.lines().nth(error.line - 1).unwrap_or("");
            assert!((1..=line.chars().count() + 1).contains(&error.column), "{error}");
        }
    });
}
