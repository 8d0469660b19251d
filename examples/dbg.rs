//! x
use umbrage::{*, program::*};
fn main(){ for t in ["tables/smsr.ron","tables/rsmss.ron"]{ let s=std::time::Instant::now(); let p=Program::read(t).unwrap_or_else(|e|panic!("{e}")); let t1=s.elapsed(); 
 for sh in plan::Shape::ALL { let s=std::time::Instant::now(); let pl=plan::Plan::new(&p,sh).unwrap(); let a=s.elapsed(); let s=std::time::Instant::now(); let pr=pl.prove().unwrap_or_else(|e|panic!("{e}")); let b=s.elapsed(); println!("{t} {sh} read {t1:?} plan {a:?} prove {b:?}: {}", pr.proof());
  for tg in emit::Target::ALL { let s=std::time::Instant::now(); match emit::emit(&pr,tg){Ok(v)=>{ println!("  {} {} bytes {:?}", tg.name(), v.len(), s.elapsed());
    std::fs::create_dir_all("/tmp/gen").unwrap(); std::fs::write(format!("/tmp/gen/{}.{}.{}",p.name,sh,tg.extension()),v).unwrap(); }, Err(e)=>println!("  {} FAIL {}", tg.name(), e)} }
 }}}
