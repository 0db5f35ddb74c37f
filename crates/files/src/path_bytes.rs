//! Paths as bytes, for texts that another process or another program reads.
use crate::sys;
use std::path::{Path, PathBuf};

/// The bytes of `path`; where paths are not bytes, its text in UTF-8.
#[must_use]
pub fn bytes_of_path(path: &Path) -> Vec<u8> {
    path.as_os_str().as_encoded_bytes().to_vec()
}

/// The path of these `bytes`.
#[must_use]
pub fn path_of_bytes(bytes: Vec<u8>) -> PathBuf {
    sys::path_of_bytes(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_arrives_as_it_was() {
        let bytes = if cfg!(unix) { b"/tmp/\xff.fmu".to_vec() } else { b"C:/\xc2\xb5.fmu".to_vec() };
        assert_eq!(bytes_of_path(&path_of_bytes(bytes.clone())), bytes);
    }
}
