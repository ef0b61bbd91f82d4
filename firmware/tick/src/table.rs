pub(crate) struct Row {
    pub(crate) q: [f32; 6],
    pub(crate) nu: [f32; 5],
    pub(crate) reference: [[f32; 3]; 3],
}
pub(crate) static TABLE: [Row; 1] = [Row { q: [0.0; 6], nu: [0.0; 5], reference: [[0.5; 3]; 3] }];
