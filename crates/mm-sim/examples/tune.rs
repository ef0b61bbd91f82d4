//! scratch
use mm_control::*; use mm_model::*; use mm_sim::{simulation::*,plant::*,disturbance::*,trajectory::*}; use nalgebra::Vector3;
fn main(){
  let a:Vec<String>=std::env::args().collect();
  let kind=LawKind::from_name(&a[1]).unwrap(); let scen=a[2].as_str();
  let p=RobotParams::<f64,3>::thesis(); let robot=Robot::try_new(p).unwrap();
  let scale = if scen=="square-compare" {1.25}else{1.0};
  let actual=Robot::try_new(p.with_mass_scaled(scale)).unwrap();
  let (path,dur)=match scen {"square"|"square-compare"=>(Path::Square,98.0),"spiral"|"spiral-compare"|"spiral-disturbed"=>(Path::Spiral,60.0),"sinusoid"=>(Path::Sinusoid,60.0),_=>(Path::Step{from:Vector3::new(0.56,0.,0.5),by:Vector3::new(0.2,0.1,0.1),at:1.0},12.0)};
  let j=|a:f64,b:f64,c:f64|Target::Torque(Torque{right:0.,left:0.,joints:[a,b,c]});
  let sine=|f,t|Disturbance{target:j(1.,1.,1.),shape:Shape::Sine{frequency:2.,phase:0.},amplitude:10.,from:f,to:t};
  let d=match scen {"square-compare"=>vec![sine(10.,60.)],"spiral-compare"=>vec![sine(10.,50.)],
   "spiral-disturbed"=>vec![Disturbance{target:j(1.,0.,0.),shape:Shape::Constant,amplitude:15.,from:20.,to:25.},Disturbance{target:j(1.,0.,0.),shape:Shape::Constant,amplitude:-15.,from:40.,to:45.}],
   "step"=>vec![Disturbance{target:j(0.,0.,1.),shape:Shape::Constant,amplitude:10.,from:5.,to:99.}],_=>vec![]};
  let get=|k:&str,def:f64|a.iter().find_map(|x|x.strip_prefix(&format!("{k}=")).map(|v|v.parse().unwrap())).unwrap_or(def);
  let mut g=Gains::for_robot(&robot,kind,1e-3);
  eprintln!("{:?}",laws::EffectiveInertia::of(&robot));
  g.observer_bandwidth=get("L",g.observer_bandwidth);
  let sc=get("sl",1.0); g.fuzzy_scale=g.fuzzy_scale.scaled(1./sc); g.switching=g.switching.scaled(get("k",1.0)); g.fuzzy=g.fuzzy.scaled(get("kf",1.0));
  let mut o=OuterParams::default(); o.position_gain=Vector3::repeat(get("K",18.)); o.sliding_gain=Velocity::splat(get("c",20.));
  let stack=ControlStack::try_new(robot,kind,StackParams{period:1e-3,outer:o,gains:g}).unwrap();
  let trajectory=Trajectory{path,start_ramp:0.};
  let r0=trajectory.at(0.); let heading=Real::atan2(r0.velocity.y,r0.velocity.x);
  let mut q=Configuration{x:0.,y:0.,heading,joints:p.rest_posture}; let tip=robot.tip_position(&q); q.x=r0.position.x-tip.x;q.y=r0.position.y-tip.y;
  let sim=Simulation{stack,plant:Plant::new(actual,Disturbances::new(d),1e-3),trajectory,initial:PlantState{q,nu:Velocity::zero(),travel:0.},clock:Clock{period:1e-3,substeps:1,ticks:(dur*1000.0) as u64,log_every:10}};
  let t=std::time::Instant::now();
  let r=sim.run(&mut NoRecorder).unwrap();
  let w=t.elapsed().as_secs_f64();
  let m=r.metrics;
  println!("{} {scen}: itae {:.5} tv {:.2} max {:.4} rms {:.2e} sat {:.4} reach {:?} manip {:.3} band {:?} {:?} x{:.0} {}",a[1],m.itae_m_s2.sum,m.torque_tv_n_m_per_s.sum,m.max_error_m,m.rmse_m.norm,m.saturated_fraction,m.reaching_condition_met,m.min_manipulability,m.sliding_band,r.ending,dur/w,r.digest);
}
